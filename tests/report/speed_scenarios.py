"""Measures the time to open and the frames drawn a second. The numbers are printed, not judged."""
import os
import time

from material import RECORDINGS
from page import expect

SECONDS = 1.0


def frames_drawn_per_second(page, seconds=SECONDS):
    """Counts frames while the report plays, over and over."""
    page.script("window.cscd.store.set({loop: true, playing: true});")
    time.sleep(0.3)
    drawn, start = page.script("return [window.cscd.viewer.framesDrawn, performance.now()];")
    time.sleep(seconds)
    drawn_then, end = page.script("return [window.cscd.viewer.framesDrawn, performance.now()];")
    page.script("window.cscd.store.set({playing: false});")
    return (drawn_then - drawn) * 1000.0 / (end - start)


def measure(page, path):
    """Returns the time from navigation to first picture in ms, the frames drawn a second, and the size in bytes."""
    page.open(path)
    return page.open_ms(), frames_drawn_per_second(page), os.path.getsize(path)


def speed_is_measured(context):
    for name in RECORDINGS:
        opened, rate, size = measure(context.page, context.material.replay(name).page)
        print(f"{name}: open after {opened:.0f} ms, {rate:.1f} frames drawn a second, {size / 1e6:.2f} MB")
        expect(opened > 0 and rate > 0, f"{name}: open after {opened} ms, {rate} frames a second")


SCENARIOS = (speed_is_measured, )
