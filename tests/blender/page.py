#!/usr/bin/env python3
"""Runs the steps of docs/artist/from-your-program.md: page.py TOOL BLEND FOLDER [--write].

Blocks of the chapter on Blender are run one after the other in FOLDER: Python in Blender with the scene BLEND, `sh` with the tool
as `cscd`. A block of text behind one holds what it prints, line by line: all that the tool prints to its standard output; of
Blender, which talks a lot, the lines that begin as those of the page do. With --write the page's blocks of text get what the tool has printed, and its
pictures are drawn.
"""
import os
import re
import shutil
import subprocess
import sys

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'docs')
PAGE = os.path.join(DOCS, 'artist', 'from-your-program.md')
SECONDS = re.compile(r'[0-9.]+ s$', re.MULTILINE)  # differ from run to run
BLOCK = re.compile(r'^```(python|sh|text)\n(.*?)^```$', re.MULTILINE | re.DOTALL)


def run_blender(text, scene, folder, **extra):
    """Blender ends with 0 also when it has not done what was asked: the marker says that the last line was reached."""
    script = os.path.join(folder, 'step.py')
    with open(script, 'w') as out:
        out.write(text + '\nprint("step done")\n')
    program = shutil.which('blender')
    path = os.path.dirname(program) + os.pathsep + os.defpath  # Blender takes modules from beside the first python3 there
    ran = subprocess.run([program, '--background', scene, '--python-exit-code', '1', '--python', script], cwd=folder,
                         capture_output=True, text=True, env={**os.environ, 'PATH': path, **extra})
    if ran.returncode != 0 or 'step done' not in ran.stdout:
        sys.exit(f'{text}\n{ran.stdout}\n{ran.stderr}\nBlender has failed')
    return ran.stdout


def run_shell(text, tool, folder):
    binaries = os.path.join(folder, 'bin')
    os.makedirs(binaries, exist_ok=True)
    if not os.path.exists(os.path.join(binaries, 'cscd')):
        os.symlink(tool, os.path.join(binaries, 'cscd'))
    ran = subprocess.run(['sh', '-e', '-c', text], cwd=folder, capture_output=True, text=True,
                         env={**os.environ, 'PATH': binaries + os.pathsep + os.environ['PATH']})
    if ran.returncode != 0:
        sys.exit(f'{text}\n{ran.stdout}\n{ran.stderr}\nended with {ran.returncode}')
    return ran.stdout


def shown_lines(expected, printed, language):
    """What the page shows of what was printed: of Blender the lines that begin with a word with which a line on the page begins."""
    if language == 'sh':
        return printed
    words = {line.split()[0] for line in expected.splitlines()}
    return ''.join(line + '\n' for line in printed.splitlines() if line.split()[:1] and line.split()[0] in words)


def draw_pictures(chapter, tool, scene, folder):
    images = os.path.join(DOCS, 'images')
    run_shell(f'cscd render doll_*.obj --frames 1:19:6 --columns 4 --size 300x400 --up y --view 20,8 -o {images}/doll.png',
              tool, folder)
    paint = open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'paint.py')).read()
    last_step = [text for language, text in BLOCK.findall(chapter) if language == 'python'][-1]
    run_blender(last_step + paint, scene, folder, PICTURE=os.path.join(images, 'doll-faces.png'))


def main():
    tool, scene, folder = (os.path.abspath(path) for path in sys.argv[1:4])
    page = open(PAGE).read()
    chapter = page[page.index('\n## Blender\n'):page.index('\n## Maya\n')]
    steps, complaints, last, written = 0, [], None, chapter
    if not os.path.exists(os.path.join(folder, 'docs')):
        os.symlink(os.path.abspath(DOCS), os.path.join(folder, 'docs'))
    for block in BLOCK.finditer(chapter):
        language, text = block.groups()
        if language != 'text':
            last = language, (run_blender(text, scene, folder) if language == 'python' else run_shell(text, tool, folder))
            steps += 1
            continue
        shown = shown_lines(text, last[1], last[0])
        if SECONDS.sub('', shown) != SECONDS.sub('', text):
            complaints.append(f'the page has\n{text}but this was printed\n{last[1]}')
            written = written.replace('```text\n' + text + '```', '```text\n' + shown + '```', 1)
    if '--write' in sys.argv:
        open(PAGE, 'w').write(page.replace(chapter, written))
        draw_pictures(chapter, tool, scene, folder)
    elif complaints:
        sys.exit('\n'.join(complaints))
    print(f'from-your-program.md: {steps} steps ran as the page shows them')
    sys.exit(steps < 8)


main()
