"""Every test has a folder of its own, in which it stands: files have plain names."""
import os

import pytest

os.environ.setdefault("CSCD_TOOL", os.path.join(os.path.dirname(__file__), "../build/release/cscd"))
for variable in ("CSCD_TOOL", "CSCD_MODELS"):
    if variable in os.environ:
        os.environ[variable] = os.path.abspath(os.environ[variable])


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    """Stands in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
