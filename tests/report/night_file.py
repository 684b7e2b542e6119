"""Writes results of jobs as `cscd check --list --results` does, made up: for pages of many jobs.

usage: night_file.py OUT.jsonl [JOBS [worst]]

worst: all jobs have intersections, and nothing repeats that could be packed.
"""
import json
import random
import sys

LIST = "0123456789abcdef"
SHOWS = ("northwind", "lanterns", "saltmarsh")
DEPARTMENTS = ("cloth_sim", "hair_sim", "anim_final", "crowd_layout")
CHARACTERS = ("grandmother", "lighthouse_keeper", "ferryman", "child_with_kite", "constable")
REASONS = ("cannot open: No such file or directory", "it took longer than 600 s", "killed by signal 9 (out of memory?)",
           "byte 8192: the file ends in the middle of frame 17")


def job_name(number, chance):
    """Returns a path of some 60 characters, as shots of a studio have it."""
    return (f"{chance.choice(SHOWS)}/sq{number // 500:03d}/sh{number // 10 % 50 * 10:04d}/{chance.choice(DEPARTMENTS)}/"
            f"{chance.choice(CHARACTERS)}_v{chance.randint(1, 30):03d}.{number % 10:02d}")


def job_line(number, count, chance):
    """Returns the line of a job, from 1: of 1,000 jobs 8 or 9 have intersections, and in 0.3 there is no answer."""
    name, draw = job_name(number, chance), chance.random()
    line = {"list": LIST, "jobs": count, "job": number, "result": "clean", "found": False, "name": name, "error": None,
            "answer": "Clean: no two triangles cross or touch in any of 120 frames.", "vertices": 25_000, "triangles": 50_000,
            "frames": 120, "frames_checked": 120, "frames_crossing": 0, "frames_touching": 0, "crossing_pairs": 0,
            "touching_pairs": 0, "duplicate_pairs": 0, "crossing_faces": 0, "crossing_share": 0.0, "contacts": 0, "depth": 0.0,
            "events": 0, "worst": None, "report": None}
    if draw < 0.0003:
        return failed(line, f"{name}: {chance.choice(REASONS)}")
    if draw < 0.0088:
        frames, depth, first = chance.randint(1, 60), chance.expovariate(10.0), chance.randint(1001, 1060)
        line.update(result="crossing", found=depth > 0.1, frames_crossing=frames, events=chance.randint(1, 9), depth=depth,
                    crossing_pairs=frames * chance.randint(2, 400), report=f"pages/{name}.html",
                    answer=f"Frames {first} to {first + frames} cross ({frames} of 120). 2 events, worst: shirt x body, "
                    f"frames {first} to {first + frames}, {depth:.4f} deep at frame {first + frames // 2}.")
    elif draw < 0.02:
        line.update(result="touching", frames_touching=3, touching_pairs=7, answer="Only touching: frames 1001 to 1003.")
    return line


def worst_line(number, count, chance):
    """Returns the line of a job with intersections, of which every value is random."""
    name, frames, first = f"lanterns/sq{number // 500:03d}/{chance.getrandbits(160):040x}", chance.randint(1, 120), chance.randint(1, 9999)
    line = job_line(number, count, chance)
    line.update(result="crossing", found=chance.random() < 0.5, name=name, error=None, frames_checked=120, frames_crossing=frames,
                events=chance.randint(1, 99), depth=chance.expovariate(10.0), crossing_pairs=chance.randint(1, 1_000_000),
                report=f"pages/{name}.html",
                answer=f"Frames {first} to {first + frames} cross ({frames} of 120). {chance.randint(1, 99)} events, worst: shirt x "
                f"body, frames {first} to {first + frames}, {chance.random():.4g} deep at frame {chance.randint(first, first + frames)}.")
    return line


def failed(line, reason):
    """Returns the line of a job without an answer, of which all members are null but the first ones."""
    first = ("list", "jobs", "job", "found", "name")
    return {key: "failed" if key == "result" else reason if key == "error" else value if key in first else None
            for key, value in line.items()}


def write_night(path, count, seed=1, lines=None, make=job_line):
    """Writes the lines of jobs; lines: members of some, by number, None for a job that is missing."""
    chance = random.Random(seed)
    written = []
    with open(path, "w", encoding="utf-8") as file:
        for number in range(1, count + 1):
            line = make(number, count, chance)
            if lines is not None and number in lines:
                line = lines[number] and {**line, **lines[number]}
            if line is not None:
                file.write(json.dumps(line, ensure_ascii=False, separators=(",", ":")) + "\n")
                written.append(line)
    return written


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    write_night(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 100_000, make=worst_line if len(sys.argv) > 3 else job_line)
