#!/usr/bin/python3
"""Builds mutants of the library, each with one planted fault, and shows which test catches it: `make test-mutants`.

mutants.txt lists them. Sources are copied to build/mutants/tree, which is kept, so that a later run compiles little; the
checkout is never changed. A mutant that no longer applies, one that does not compile and one that no test catches have
failed. Tests may hang on a mutant: that counts as caught, like a wrong result.

SAMPLE=HASH (as hexadecimal digits, such as a commit's) takes a few of them, the same for the same hash; ONLY="word word"
those with one of the words in their names. The last line is `N passed, M failed`. With the argument --applies nothing is
built: it prints the mutants of the whole list that do not apply, for the lint.
"""
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TREE = ROOT / "build/mutants/tree"
COPIED = ("Makefile", ".ci/packages", "include", "src", "preprocess", "runtime", "models", "benchmarks", "tests")
# A compiler that remembers gives what make test has compiled. Others optimise a little, without symbols: the quickest to build and run.
REMEMBERS = "ccache" in os.environ.get("CC", "")
MAKE = ("make", "-s", f"-j{os.cpu_count()}", *(() if REMEMBERS else ("CFLAGS=-O1 -g0 -w",)))
SAMPLE_SIZE = 3
# So many seconds more than without a fault, and so many times as long, before a test counts as hanging.
PATIENCE, PATIENCE_FACTOR = 5.0, 10.0


class Mutant:
    """One block of the list."""

    def __init__(self, name):
        self.name, self.about, self.file, self.tests = name, "", "", []
        self.old, self.new = "", ""


def read_list(path):
    """The blocks of a list: `mutant NAME`, `about`, `file`, `tests`, and lines that begin with - (out) and + (in)."""
    mutants = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        word, _, rest = line.partition(" ")
        if line.startswith("#") or not line.strip():
            continue
        if word == "mutant":
            mutants.append(Mutant(rest))
        elif word == "about":
            mutants[-1].about += (" " if mutants[-1].about else "") + rest
        elif word == "file":
            mutants[-1].file = rest
        elif word == "tests":
            mutants[-1].tests = rest.split()
        elif line[0] == "-":
            mutants[-1].old += line[1:] + "\n"
        elif line[0] == "+":
            mutants[-1].new += line[1:] + "\n"
        else:
            sys.exit(f"{path}:{number}: neither a word of the list nor a line that begins with - or +: {line}")
    return mutants


def chosen_of(mutants):
    """Those that SAMPLE or ONLY name, or all."""
    sample, words = os.environ.get("SAMPLE", ""), os.environ.get("ONLY", "").split()
    if words:
        return [m for m in mutants if any(word in m.name for word in words)]
    if not sample:
        return mutants
    try:
        number = int(sample, 16)
    except ValueError:
        sys.exit(f"mutants: SAMPLE={sample}: not hexadecimal digits")
    left, taken = list(mutants), []
    while left and len(taken) < SAMPLE_SIZE:
        taken.append(left.pop(number % len(left)))
        number //= len(left) + 1
    return taken


def copy_sources():
    """Brings the copy up to date; files that are the same keep their times, for make."""
    listed = subprocess.run(("git", "ls-files", "-co", "--exclude-standard", *COPIED), cwd=ROOT, check=True, text=True,
                            capture_output=True).stdout.splitlines()
    listed = [name for name in listed if (ROOT / name).is_file()]
    for name in listed:
        target, text = TREE / name, (ROOT / name).read_bytes()
        if target.is_file() and target.read_bytes() == text:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(text)
    for room in (TREE / top for top in COPIED if (TREE / top).is_dir()):
        for path in room.rglob("*"):
            if path.is_file() and str(path.relative_to(TREE)) not in set_of(listed):
                path.unlink()


def set_of(names, kept={}):
    """The names as a set, made once."""
    return kept.setdefault(id(names), set(names))


def program_of(test):
    return f"build/release/tests/{test}"


def build(tests):
    """Builds tests in the copy; returns what the compiler says when that fails."""
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES", "ONLY", "SAMPLE", "CONFIG", "BUILD")}
    made = subprocess.run((*MAKE, *(program_of(test) for test in tests)), cwd=TREE, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return None if made.returncode == 0 else made.stdout or "make failed"


def run_test(test, limit=None):
    """What goes wrong, None for nothing; and the seconds that it took."""
    environment = {name: value for name, value in os.environ.items() if name != "CSCD_DATA"}
    since = time.monotonic()
    try:
        code = subprocess.run((f"./{program_of(test)}",), cwd=TREE, timeout=limit, env=environment, check=False,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
    except subprocess.TimeoutExpired:
        return f"hangs: not done after {limit:.0f} s", time.monotonic() - since
    how = None if code == 0 else f"fails with {code}" if code > 0 else f"is ended by signal {-code}"
    return how, time.monotonic() - since


def text_below(folder, mutant):
    """The text that the fault goes into, as it is now. A sentence, when it does not apply."""
    path = folder / mutant.file
    if not path.is_file():
        return None, f"does not apply: {mutant.file} is gone; plant the fault where its code is now"
    text = path.read_text(encoding="utf-8")
    found = text.count(mutant.old)
    if found != 1:
        return None, f"does not apply: its lines stand {found} times in {mutant.file}, not once; " \
                     "write the lines of today into tests/mutants/mutants.txt"
    return text, None


def plant(mutant):
    """Puts the fault into the copy; returns the text that was there. A sentence, when it does not apply."""
    text, problem = text_below(TREE, mutant)
    if not problem:
        (TREE / mutant.file).write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
    return text, problem


def try_mutant(mutant, seconds):
    """Returns whether it is caught, and a sentence."""
    text, problem = plant(mutant)
    if problem:
        return False, problem
    try:
        problem = build(mutant.tests)
        if problem:
            return False, "does not compile:\n" + problem
        for test in mutant.tests:
            how, _ = run_test(test, PATIENCE + PATIENCE_FACTOR * seconds[test])
            if how:
                return True, f"{test} {how}"
        return False, "is caught by none of " + ", ".join(mutant.tests)
    finally:
        (TREE / mutant.file).write_text(text, encoding="utf-8")


def print_stale(mutants):
    """The mutants that do not apply to the checkout; returns how many."""
    stale = [(mutant, text_below(ROOT, mutant)[1]) for mutant in mutants]
    stale = [(mutant, problem) for mutant, problem in stale if problem]
    for mutant, problem in stale:
        print(f"mutant {mutant.name} {problem}")
    return len(stale)


def main():
    mutants = read_list(Path(__file__).with_name("mutants.txt"))
    if sys.argv[1:] == ["--applies"]:
        sys.exit(print_stale(mutants) > 0)
    mutants = chosen_of(mutants)
    if not mutants:
        sys.exit("mutants: none is chosen")
    tests = sorted({test for mutant in mutants for test in mutant.tests})
    failed = 0
    copy_sources()
    problem = build(tests)
    if problem:
        sys.exit("mutants: without a fault the copy does not build:\n" + problem)
    seconds = {}
    for test in tests:
        how, seconds[test] = run_test(test)
        if how:
            sys.exit(f"mutants: {test} {how} without a fault")
    for mutant in mutants:
        since = time.monotonic()
        caught, sentence = try_mutant(mutant, seconds)
        failed += not caught
        print(f"{'caught' if caught else 'FAILED'}  {mutant.name}: {mutant.about}\n        {sentence} "
              f"({time.monotonic() - since:.1f} s)", flush=True)
    print(f"{len(mutants) - failed} passed, {failed} failed")
    sys.exit(failed > 0)


main()
