"""A copy of the sources, in which mutants are planted, built and tried."""
import os
import re
import subprocess

from mutants import ROOT

COPIED = ("Makefile", ".ci/packages", "include", "src", "preprocess", "runtime", "sensors", "tool", "packaging", "models", "benchmarks", "tests", "docs/man",
          "README.md", "CMakeLists.txt")
# A compiler that remembers gives what make test has compiled. Others optimise a little, without symbols: the quickest to build and run.
REMEMBERS = "ccache" in os.environ.get("CC", "")
NOT_PASSED_ON = ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES", "ONLY", "ROOM", "SAMPLE", "CONFIG", "BUILD", "CSCD_DATA",
                 "NIGHTLY", "BASELINES", "EXPAT", "DYNAMIC", "HOST", "BUILD_ROOT")
# A test that takes longer than so many seconds with a fault hangs.
PATIENCE = 100.0
BUILD = "build/release"
# What tests run besides: the words that their sources have then, and what is made.
RUN_BY_TESTS = {r"support\.tool|CSCD_TOOL": (f"{BUILD}/cscd",), "CSCD_MODELS|model_program": ("models",),
                **{f"CSCD_{name.upper()}": (f"{BUILD}/benchmarks/{name}",) for name in ("queries", "methods", "volumes")}}


def listed_files():
    """The files of the checkout that are copied, as paths from its root."""
    listed = subprocess.run(("git", "ls-files", "-co", "--exclude-standard", *COPIED), cwd=ROOT, check=True, text=True,
                            capture_output=True).stdout.splitlines()
    return [name for name in listed if (ROOT / name).is_file()]


class Tree:
    """One copy; several may work at the same time. It is kept, so that a later run compiles little."""

    def __init__(self, number):
        self.folder = ROOT / f"build/mutants/tree{number}"
        self.passing = set()  # tests that have passed without a fault
        self.environment = {name: value for name, value in os.environ.items() if name not in NOT_PASSED_ON}
        build = self.folder / BUILD
        self.environment.update(CSCD_TOOL=str(build / "cscd"), CSCD_MODELS=str(build / "models"),
                                **{f"CSCD_{name.upper()}": str(build / "benchmarks" / name) for name in ("queries", "methods", "volumes")})

    def copy(self):
        """Brings the copy up to date; files that are the same keep their times, for make."""
        listed = listed_files()
        for name in listed:
            source, target = ROOT / name, self.folder / name
            if not target.is_file() or target.read_bytes() != source.read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(source.read_bytes())
            if target.stat().st_mode != source.stat().st_mode:
                target.chmod(source.stat().st_mode)
        kept = set(listed)
        for top in COPIED:
            for path in (self.folder / top).rglob("*") if (self.folder / top).is_dir() else ():
                if path.is_file() and str(path.relative_to(self.folder)) not in kept:
                    path.unlink()

    def make(self, targets):
        """Builds in the copy; returns what the compiler says when that fails."""
        flags = () if REMEMBERS else ("CFLAGS=-O1 -g0 -w",)
        made = subprocess.run(("make", "-s", *flags, *targets), cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return None if made.returncode == 0 else made.stdout or "make failed"

    def tests_of(self, room):
        """The programs of a folder of tests, as room/test_name."""
        return sorted(f"{room}/{path.stem}" for path in (self.folder / "tests" / room).glob("test_*.*"))

    def build(self, tests):
        """Builds tests and what they may run; returns what goes wrong."""
        sources = "\n".join(next((self.folder / "tests").glob(f"{test}.*")).read_text(encoding="utf-8") for test in tests)
        run = [target for words, targets in RUN_BY_TESTS.items() if re.search(words, sources) for target in targets]
        return self.make((*(f"{BUILD}/tests/{test}" for test in tests), *run))

    def run(self, test):
        """The cases of a test that fail: none, if it passes."""
        try:
            done = subprocess.run((f"./{BUILD}/tests/{test}",), cwd=self.folder, timeout=PATIENCE, env=self.environment, check=False,
                                  text=True, errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired:
            return ["(hangs)"]
        failed = sorted(set(re.findall(r"^\[  FAILED  \] ([A-Za-z_]\w*)$", done.stdout, re.MULTILINE)))
        if done.returncode < 0:
            failed.append(f"(signal {-done.returncode})")
        elif done.returncode > 0 and not failed:
            failed.append(f"(exit code {done.returncode})")
        return failed if done.returncode != 0 else []

    def passes(self, tests):
        """None, if tests pass without a fault; each is asked once. Or a sentence."""
        new = [test for test in tests if test not in self.passing]
        problem = self.build(new) if new else None
        if problem:
            return "cannot be tried: without a fault the copy does not build:\n" + problem
        for test in new:
            failed = self.run(test)
            if failed:
                return f"cannot be tried: {test} fails without a fault: {', '.join(failed)}"
            self.passing.add(test)
        return None
