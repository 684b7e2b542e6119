"""The lists of mutants: what they say, which of them are asked for, and the tests of their rooms."""
import hashlib
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LISTS = Path(__file__).parent
SAMPLE_SIZE = 3


class Mutant:
    """One block of a list: a file, the lines that go out and those that come in."""

    def __init__(self, name, where):
        self.name, self.where, self.about, self.file, self.caught = name, where, "", "", []
        self.old, self.new = "", ""

    def room(self):
        """The folder of the list, which is the folder of the sources: runtime/ccd."""
        return str(self.where.with_suffix("").relative_to(LISTS))

    def own_tests(self):
        """The folder of tests that is called as the room, or as the nearest one above it."""
        for place in (Path(self.file).parent, *Path(self.file).parent.parents):
            if place.name and any((ROOT / "tests" / place.name).glob("test_*.*")):
                return place.name
        return None

    def text_below(self, folder):
        """The text that the fault goes into, as it is now, and None; or None and a sentence, when it does not apply."""
        path = folder / self.file
        if not path.is_file():
            return None, f"does not apply: {self.file} is gone; plant the fault where its code is now"
        text = path.read_text(encoding="utf-8")
        found = text.count(self.old)
        if found != 1:
            return None, f"does not apply: its lines stand {found} times in {self.file}, not once; " \
                         f"write the lines of today into {self.where.relative_to(ROOT)}"
        return text, None

    def programs(self):
        """The test programs that have caught it before, and are still there."""
        names = [caught.split(":")[0] for caught in self.caught]
        return [name for name in names if any((ROOT / "tests").glob(f"{name}.*"))]

    def keep(self, caught):
        """Writes into its list what catches it now."""
        self.caught, kept, inside = caught, [], False
        for line in self.where.read_text(encoding="utf-8").splitlines():
            word, _, rest = line.partition(" ")
            inside = rest == self.name if word == "mutant" else inside
            if inside and word == "caught":
                continue
            kept.append(line)
            if inside and word == "file":
                kept += [f"caught {what}" for what in caught]
        self.where.write_text("\n".join(kept) + "\n", encoding="utf-8")

    def digest(self):
        """Changes when the fault or the file that it goes into does."""
        whole = "\0".join((self.old, self.new, (ROOT / self.file).read_text(encoding="utf-8")))
        return hashlib.sha1(whole.encode()).hexdigest()[:12]


def read_list(path):
    """The blocks of a list: `mutant NAME`, `about`, `file`, `caught` by what, and lines that begin with - (out) and + (in)."""
    mutants = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        word, _, rest = line.partition(" ")
        if line.startswith("#") or not line.strip():
            continue
        if word == "mutant":
            mutants.append(Mutant(rest, path))
        elif word == "about":
            mutants[-1].about += (" " if mutants[-1].about else "") + rest
        elif word == "file":
            mutants[-1].file = rest
        elif word == "caught":
            mutants[-1].caught.append(rest)
        elif line[0] == "-":
            mutants[-1].old += line[1:] + "\n"
        elif line[0] == "+":
            mutants[-1].new += line[1:] + "\n"
        else:
            sys.exit(f"{path}:{number}: neither a word of the list nor a line that begins with - or +: {line}")
    return mutants


def read_all():
    """The mutants of all lists; two have never one name."""
    mutants = [mutant for path in sorted(LISTS.rglob("*.txt")) for mutant in read_list(path)]
    names = [mutant.name for mutant in mutants]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        sys.exit("mutants: two have the name " + ", ".join(twice))
    return mutants


def chosen_of(mutants):
    """Those of the ROOMs and with the words of ONLY in their names, of which SAMPLE takes a few; or all."""
    sample, words, rooms = (os.environ.get(name, "") for name in ("SAMPLE", "ONLY", "ROOM"))
    if rooms:
        mutants = [m for m in mutants if m.room() in rooms.split()]
    if words:
        mutants = [m for m in mutants if any(word in m.name for word in words.split())]
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


def stale_of(mutants):
    """What does not apply to the checkout: a sentence for each."""
    problems = []
    for mutant in mutants:
        problem = mutant.text_below(ROOT)[1]
        if problem:
            problems.append(f"mutant {mutant.name} {problem}")
        gone = [caught for caught in mutant.caught if caught.split(":")[0] not in mutant.programs()]
        problems += [f"mutant {mutant.name}: there is no test {caught}" for caught in gone]
    return problems
