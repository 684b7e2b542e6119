"""Why a run could not finish is said once, whether its two outputs go to one place or to two."""
import shlex
import subprocess
from pathlib import Path

import pytest

from support.tool.running import command


@pytest.mark.parametrize("name", ["check", "replay"])
@pytest.mark.parametrize("options", ["", "--fail-on crossing", "--quiet", "2>/dev/null", ">/dev/null"])
def test_the_reason_is_said_once(name, options):
    """Where both outputs go to one place, the first line gives the reason; it is not lost where only one is kept."""
    for path, spoilt in (("f_1.obj", ""), ("f_2.obj", "v 1 2 3\n")):
        Path(path).write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{spoilt}f 1 2 3\n")
    line = f"{{ {shlex.join(command(f'{name} f_1.obj f_1.obj f_2.obj'))} {options}; }} 2>&1"
    ended = subprocess.run(line, shell=True, stdout=subprocess.PIPE, text=True, check=False)
    assert ended.returncode == 1 and ended.stdout.count("holds 4 vertices") == 1
