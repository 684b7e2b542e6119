#!/usr/bin/python3
"""Builds mutants, each with one planted fault, and shows which test catches it: `make test-mutants`.

The lists stand beside this file, one for each room: runtime/ccd.txt for runtime/ccd. Sources are copied to build/mutants, a copy
for each processor, which are kept, so that a later run compiles little; the checkout is never changed. A mutant is tried with
the tests that have caught it before, as its list says, then with all of its room, and the first that fails has caught it. One
that no longer applies, one that does not compile and one that no test catches have failed. Tests may hang on a mutant: that
counts as caught, like a wrong result.

ROOM="runtime/ccd tool/io" takes those of rooms, ONLY="word word" those with one of the words in their names, SAMPLE=HASH (as
hexadecimal digits, such as a commit's) a few of them, the same for the same hash. MATRIX=1 goes on after the first test, so that
all tests of the room that catch a mutant are listed. KEEP=1 writes what caught them into the lists. RESUME=1 leaves out those that
were caught in an earlier run, and whose files are the same. The last line is `N passed, M failed`. With the argument --applies
nothing is built: it prints the mutants of all lists that do not apply, for the lint.
"""
import os
import queue
import sys
import threading
import time

import mutants as lists
from tree import Tree

DONE = lists.ROOT / "build/mutants/done.txt"


class Done:
    """What earlier runs have caught: lines of a name, a tab and the digest of the fault and its file."""

    def __init__(self, path):
        self.path = path
        self.lines = dict(line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()) if path.is_file() else {}

    def has(self, mutant):
        """Was it caught, and is it the same?"""
        return self.lines.get(mutant.name) == mutant.digest()

    def add(self, mutant):
        """Keeps it at once, as a run may be ended."""
        self.lines[mutant.name] = mutant.digest()
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text("".join(f"{name}\t{digest}\n" for name, digest in self.lines.items()), encoding="utf-8")


class Run:
    """All that the trees share."""

    def __init__(self, chosen):
        self.chosen, self.done = chosen, Done(DONE)
        self.matrix, self.keeps = os.environ.get("MATRIX", "") == "1", os.environ.get("KEEP", "") == "1"
        self.failed, self.problem, self.lock = [], None, threading.Lock()
        self.left = queue.Queue()
        for mutant in chosen:
            if os.environ.get("RESUME", "") != "1" or not self.done.has(mutant):
                self.left.put(mutant)
        self.before = len(chosen) - self.left.qsize()

    def tests_for(self, tree, mutant):
        """The programs to try: those that are likely to catch it, and the others of its room."""
        room = mutant.own_tests()
        likely = mutant.programs()
        return likely, [test for test in (tree.tests_of(room) if room else ()) if test not in likely]

    def try_tests(self, tree, mutant):
        """What catches it, and None; or a sentence. Those that are likely to are built one by one."""
        caught, likely, others = [], *self.tests_for(tree, mutant)
        for tests in (*([test] for test in likely), others):
            problem = tree.build(tests) if tests else None
            if problem:
                return caught, "does not compile:\n" + problem
            for test in tests:
                cases = tree.run(test)
                if cases:
                    caught.append(f"{test}: {', '.join(cases)}")
                    if not self.matrix:
                        return caught, None
        return caught, None if caught else f"is caught by none of {len(likely) + len(others)} tests" + (
            f", all of {mutant.own_tests()} among them" if mutant.own_tests() else ": name one, as `caught room/test_name`")

    def try_mutant(self, tree, mutant):
        """Plants it, tries it, and takes it out again. What has caught it must pass without it."""
        since = time.monotonic()
        text, problem = mutant.text_below(tree.folder)
        caught = []
        if not problem:
            path = tree.folder / mutant.file
            path.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")
            try:
                caught, problem = self.try_tests(tree, mutant)
            finally:
                path.write_text(text, encoding="utf-8")
        if not problem:
            problem = tree.passes([line.split(":")[0] for line in caught])
        self.tell(mutant, caught, problem, time.monotonic() - since)

    def tell(self, mutant, caught, problem, seconds):
        """One at a time."""
        with self.lock:
            if problem:
                self.failed.append(mutant)
            else:
                self.done.add(mutant)
                if self.keeps:
                    mutant.keep(caught)
            print(f"{'FAILED' if problem else 'caught'}  {mutant.name}: {mutant.about}\n        "
                  f"{problem or '; '.join(caught)} ({seconds:.1f} s)", flush=True)

    def work(self, tree):
        """Takes mutants until there are none."""
        try:
            while True:
                self.try_mutant(tree, self.left.get_nowait())
        except queue.Empty:
            pass
        except Exception as error:  # a thread's own would be lost
            self.problem = error

    def all(self):
        """Tries them, in as many trees as there are processors."""
        threads = []
        for number in range(min(len(os.sched_getaffinity(0)), self.left.qsize())):
            tree = Tree(number)
            tree.copy()
            threads.append(threading.Thread(target=self.work, args=(tree,)))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if self.problem:
            raise self.problem

    def tell_rooms(self):
        """How many there are in each room, and how many live."""
        rooms = sorted({mutant.room() for mutant in self.chosen})
        for room in rooms:
            count = sum(mutant.room() == room for mutant in self.chosen)
            alive = [mutant.name for mutant in self.failed if mutant.room() == room]
            print(f"{room}: {count - len(alive)} of {count} caught" + (f"; not {', '.join(alive)}" if alive else ""))


def main():
    everything = lists.read_all()
    if sys.argv[1:] == ["--applies"]:
        stale = lists.stale_of(everything)
        print("\n".join(stale), end="\n" if stale else "")
        sys.exit(len(stale) > 0)
    chosen = lists.chosen_of(everything)
    if not chosen:
        sys.exit("mutants: none is chosen")
    run = Run(chosen)
    run.all()
    run.tell_rooms()
    if run.before:
        print(f"{run.before} of them were caught in an earlier run")
    print(f"{len(chosen) - len(run.failed)} passed, {len(run.failed)} failed")
    sys.exit(len(run.failed) > 0)


main()
