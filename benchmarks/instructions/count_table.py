#!/usr/bin/env python3
"""Adds up the instructions that count_instructions.c counted, by kernel and by room, and compares columns.

usage: count_table.py NAME=PROGRAM:COUNTS...

PROGRAM is the program that ran, with its symbols; COUNTS is what the plugin wrote. The last three columns that are named avx2,
neon and scalar are compared: neon/avx2 and neon/scalar. Code of other files than ours (the C library) is in the row `libraries`.
"""
import bisect
import collections
import os
import re
import subprocess
import sys

MACHINES = {"Advanced Micro Devices X86-64": "x86_64-linux-gnu-", "AArch64": "aarch64-linux-gnu-"}


def lines_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


class Program:
    """The source file that an address of a program comes from."""

    def __init__(self, path):
        header = "\n".join(lines_of("readelf", "-hlW", path))
        self.start = min(int(address, 16) for address in re.findall(r"LOAD +\S+ (\S+) \S+ \S+ \S+ R E", header))
        tools = MACHINES[re.search(r"Machine:\s*(.*)", header)[1].strip()]
        functions = {}
        for line in lines_of(tools + "nm", "-l", "--defined-only", path):
            row = re.match(r"([0-9a-f]+) [tTwWiI] (\S+)(?:\t(.*):\d+)?$", line)
            if row:
                functions[int(row[1], 16)] = self.relative(row[3])
        self.addresses = sorted(functions)
        self.files = [functions[a] for a in self.addresses]

    @staticmethod
    def relative(path):
        """The path in the repository; None for files of others."""
        found = path and re.search(r"(?:^|/)((?:src|runtime|preprocess|tool)/.*)$", os.path.normpath(path))
        return found[1] if found else None

    def file_at(self, offset):
        place = bisect.bisect_right(self.addresses, self.start + offset) - 1
        inside = 0 <= place and self.start + offset < self.addresses[-1] + (1 << 16)
        return (self.files[place] if inside else None) or "libraries"


def count_by_file(program, counts):
    sums = collections.Counter()
    where = Program(program)
    with open(counts, encoding="ascii") as file:
        for line in file:
            offset, executed = map(int, line.split())
            sums[where.file_at(offset)] += executed
    return sums


def ratio(columns, row, above, below):
    if above not in columns or below not in columns or columns[below][row] == 0:
        return "     -"
    return f"{columns[above][row] / columns[below][row]:6.2f}"


def print_rows(title, columns, rows):
    names = list(columns)
    print(f"\n{title:<44}" + "".join(f"{name:>10}" for name in names) + "  neon/avx2 neon/scalar")
    for row in rows:
        millions = "".join(f"{columns[name][row] / 1e6:10.1f}" for name in names)
        print(f"{row:<44}{millions}     {ratio(columns, row, 'neon', 'avx2')}      {ratio(columns, row, 'neon', 'scalar')}")


def main(arguments):
    columns = {}
    for argument in arguments:
        name, program, counts = re.fullmatch(r"([^=]+)=([^:]+):(.+)", argument).groups()
        columns[name] = count_by_file(program, counts)
    files = {file for column in columns.values() for file in column}
    largest = {file: max(column[file] for column in columns.values()) for file in files}
    kernels = [file for file in files if file.endswith(("_simd.c", "_simd.h")) and largest[file] >= 1e5]
    print("Millions of instructions")
    print_rows("kernel", columns, sorted(kernels, key=lambda file: -largest[file]))
    rooms = collections.defaultdict(collections.Counter)
    for name, column in columns.items():
        rooms[name].update({"all": sum(column.values())})
        for file, count in column.items():
            rooms[name][os.path.dirname(file) or file] += count
    names = {room for column in rooms.values() for room in column}
    print_rows("room", rooms, sorted(names, key=lambda room: -max(column[room] for column in rooms.values())))


if __name__ == "__main__":
    main(sys.argv[1:])
