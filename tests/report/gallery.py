#!/usr/bin/python3
"""Draws the pictures of docs/artist/guide.md.

usage: gallery.py REPORT.html PLAN.html COMPARISON.html IMAGES
"""
import base64
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

from page import Page  # noqa: E402

EVENT = 1  # of the pawn: where its head is pressed into the collar


def save(page, folder, name):
    page.rest()
    shown = page.command("Page.captureScreenshot", format="png")["data"]
    with open(os.path.join(folder, name), "wb") as file:
        file.write(base64.b64decode(shown))


def main():
    if len(sys.argv) != 5:
        print(__doc__.strip())
        return 2
    replay, plan, comparison, folder = sys.argv[1:]
    page = Page()
    try:
        page.open(replay, unfold=False)
        page.script("window.cscd.player.toEvent(arguments[0]);", EVENT)
        save(page, folder, "report.png")
        page.open(plan, theme="dark")
        save(page, folder, "report-plan.png")
        page.open(comparison)
        shown = page.command("Page.captureScreenshot", format="png")["data"]
        with open(os.path.join(folder, "report-comparison.png"), "wb") as file:
            file.write(base64.b64decode(shown))
    finally:
        page.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
