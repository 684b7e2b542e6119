"""tests/run.sh itself: what it counts as passed and as failed, and how it treats recordings to compare with."""
import re

import pytest

from support.install.built_tree import CC, shell

GOOD = "echo '[  PASSED  ] 3 test(s).'"


@pytest.fixture
def run_script(tmp_path):
    def run(body, code, **variables):
        """What the script prints for a program."""
        program = tmp_path / "program"
        program.write_text(f"#!/bin/sh\n{body}\n")
        program.chmod(0o755)
        return shell(f"tests/run.sh '{program}'", code=code, BUILD=str(tmp_path), **{"CSCD_DATA": "", **variables})

    return run


@pytest.mark.parametrize("body, code, says", [
    (GOOD, 0, "\n3 passed, 0 failed\n"),
    ("echo '[  PASSED  ] 2 test(s).'; echo '[  FAILED  ] 1 test(s), listed below:'; exit 1", 1, "/program\n2 passed, 1 failed\n"),
    ("echo", 1, "/program\n0 passed, 1 failed\n"),  # silence is a failure
    (f"{GOOD}; exit 134", 1, "/program\n3 passed, 1 failed\n"),
])
def test_totals_are_added_up(run_script, body, code, says):
    assert says in run_script(body, code)


def test_no_program_is_a_failure(tmp_path):
    assert "0 passed, 1 failed\n" in shell("tests/run.sh /no-such-program", code=1, BUILD=str(tmp_path), CSCD_DATA="")
    assert "nothing is tested" in shell("tests/run.sh", code=1, BUILD=str(tmp_path))


def test_a_name_that_chooses_nothing_is_a_failure(tmp_path):
    """Of cases of a file in C, or of files."""
    (tmp_path / "test_a.c").write_text('#include "tests/support/test.h"\nTEST(first) {}\nTEST(second) {}\n')
    flags = """-D_GNU_SOURCE -DTEST_FILE='"test_a"' -I."""
    shell(f"{CC} {flags} -o {tmp_path}/test_a {tmp_path}/test_a.c tests/support/room.c -lcmocka")
    for cases, passed in (("", 2), ("first", 1), ("'?e*d'", 1), ("'*s*'", 2)):
        assert f"[  PASSED  ] {passed} test(s).\n" in shell(f"{tmp_path}/test_a {cases}")
    assert shell(f"{tmp_path}/test_a 'third*'", code=1) == "test_a has no test that is called third*\n"
    assert 'no test has a word of ONLY="no-such-word"' in shell("make test ONLY=no-such-word", code=2)


def test_named_recordings_must_be_there(run_script, tmp_path):
    assert "CSCD_DATA is not set, nothing to compare\n" in run_script(GOOD, 0)
    for folder in (tmp_path / "no-such-folder", tmp_path):
        assert "failed: check_recordings.py\n3 passed, 1 failed\n" in run_script(GOOD, 1, CSCD_DATA=str(folder))


def test_slowest_programs_are_listed(run_script):
    printed = run_script(f"i=0\nwhile [ $i -lt 100000 ]; do i=$((i + 1)); done\n{GOOD}", 0)
    seconds = re.search(r"slowest, in seconds.*\n +([\d.]+) .*/program\n", printed)
    assert seconds and float(seconds.group(1)) > 0
