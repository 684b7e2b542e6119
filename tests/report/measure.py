#!/usr/bin/python3
"""Prints how long reports take to open, how many frames are drawn a second while they play, and how large they are.

usage: measure.py REPORT.html...

In a window of 1280 by 800 pixels of Chromium, drawn without a graphics processor; opening: the median of five.
"""
import os
import statistics
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

from page import HEIGHT, WIDTH, Page  # noqa: E402
from report_file import Report  # noqa: E402

OPENINGS = 5


def frames_drawn_per_second(page, seconds):
    """Counts frames while the report plays, over and over."""
    page.script("window.cscd.store.set({loop: true, playing: true});")
    time.sleep(0.3)
    drawn, start = page.script("return [window.cscd.viewer.framesDrawn, performance.now()];")
    time.sleep(seconds)
    drawn_then, end = page.script("return [window.cscd.viewer.framesDrawn, performance.now()];")
    page.script("window.cscd.store.set({playing: false});")
    return (drawn_then - drawn) * 1000.0 / (end - start)


def measure(page, path):
    opened = []
    for _ in range(OPENINGS):
        page.open(path)
        opened.append(page.open_ms())
    replay = Report(path).document["kind"] == "replay"
    rate = f"{frames_drawn_per_second(page, 5.0):9.1f}" if replay else f"{'-':>9}"
    print(f"{os.path.basename(path):<32} {statistics.median(opened):9.0f} {max(opened):9.0f} {rate} "
          f"{os.path.getsize(path) / 1e6:9.2f}", flush=True)


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        return 2
    page = Page()
    try:
        browser = page.driver.capabilities
        print(f"{browser['browserName']} {browser['browserVersion']}, {WIDTH} x {HEIGHT}, drawn by software, "
              f"{os.cpu_count()} processors")
        print(f"{'report':<32} {'open ms':>9} {'most':>9} {'frames/s':>9} {'MB':>9}")
        for path in sys.argv[1:]:
            measure(page, path)
    finally:
        page.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
