"""The tool on a capsule whose ends touch in a known interval: a formula, brute force and all outputs agree."""
import re
import subprocess

import pytest

from support.tool.reading import read_contacts, read_json
from support.tool.running import model_program, run


@pytest.fixture(scope="module")
def capsule(tmp_path_factory):
    """The recording, and what a replay of it has left."""
    folder = tmp_path_factory.mktemp("capsule")
    made = subprocess.run(model_program("capsule_bend", "capsule.obj", "capsule.pc2"), cwd=folder, check=True, text=True,
                          capture_output=True)
    answer = run("replay capsule.obj capsule.pc2 --method single --contacts contacts.csv --json summary.json", cwd=folder)
    return (folder, int(re.search(r"first contact expected in interval (\d+)", made.stdout).group(1)), answer.out,
            read_contacts(folder / "contacts.csv"), read_json(folder / "summary.json"))


def test_the_first_contact_is_where_the_formula_says(capsule):
    _, expected, _, contacts, _ = capsule
    assert 1 <= expected <= 58 and contacts[0].frame == expected == min(contact.frame for contact in contacts)


def test_brute_force_finds_the_same(capsule):
    """Over all feature pairs of the first interval with contacts it gives the same list, number for number."""
    folder, expected, _, contacts, _ = capsule
    line = f"replay capsule.obj capsule.pc2 --frames {expected}:{expected + 1} --method brute --no-check --quiet"
    run(f"{line} --contacts brute.csv", cwd=folder)
    assert read_contacts(folder / "brute.csv") == [contact for contact in contacts if contact.frame == expected]


def test_csv_json_and_table_agree(capsule):
    _, _, out, contacts, root = capsule
    assert [interval["frame"] for interval in root["intervals"]] == list(range(59)) and len(root["frames"]) == 60
    for interval in root["intervals"]:
        kinds = [contact.kind for contact in contacts if contact.frame == interval["frame"]]
        assert [interval["vf"], interval["ee"]] == [kinds.count("vf"), kinds.count("ee")]
        assert (interval["earliest_toi"] is None) == (kinds == [])
    kinds = [contact.kind for contact in contacts]
    touched = len({contact.frame for contact in contacts})
    assert f"\ncontacts: {kinds.count('vf')} VF and {kinds.count('ee')} EE in {touched} of 59 intervals" in out


def test_frames_cross_after_the_first_contact(capsule):
    """Frames up to the first contact have no intersections; in those after it the ends intersect."""
    _, expected, _, _, root = capsule
    assert [frame["crossing"] for frame in root["frames"]] == [k > expected for k in range(60)]
