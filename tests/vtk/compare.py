#!/usr/bin/env python3
"""Reads what `check` and `replay` write by --vtk with VTK itself: compare.py TOOL FOLDER.

Every array must hold, number by number, what the other outputs of the same runs say: the JSON of `check`, the contacts of
`replay`, the lists of --select, the plan, the files of the frames. The .pvd files are read as XML, and name the files that exist.
"""
import collections
import glob
import json
import os
import subprocess
import sys
import xml.etree.ElementTree

import vtk

import scene


def read_vtp(path):
    """Arrays as lists by name: point data, cell data, field data, points, cells."""
    errors = []
    reader = vtk.vtkXMLPolyDataReader()
    reader.AddObserver('ErrorEvent', lambda *_: errors.append(path))
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    assert not errors and reader.GetErrorCode() == 0, f'{path}: VTK reads it with errors'

    def arrays(group):
        return {a.GetName(): [a.GetValue(k) for k in range(a.GetNumberOfValues())]
                for a in (group.GetAbstractArray(i) for i in range(group.GetNumberOfArrays()))}

    cells = [[c.GetPointId(k) for k in range(c.GetNumberOfPoints())]
             for c in (data.GetCell(i) for i in range(data.GetNumberOfCells()))]
    return {'points': arrays(data.GetPointData()), 'cells': arrays(data.GetCellData()),
            'field': arrays(data.GetFieldData()),
            'places': [data.GetPoint(i) for i in range(data.GetNumberOfPoints())], 'corners': cells}


def read_pvd(path, numbers, times):
    """The file of each frame."""
    sets = xml.etree.ElementTree.parse(path).getroot().findall('./Collection/DataSet')
    assert [float(s.get('timestep')) for s in sets] == times, path
    files = [os.path.join(os.path.dirname(path), s.get('file')) for s in sets]
    assert all(map(os.path.isfile, files)), f'{path} names files that are not there'
    assert [int(f[-len('0000.vtp'):-len('.vtp')]) for f in files] == numbers, path
    return files


def read_obj(path):
    lines = [line.split() for line in open(path)]
    return ([tuple(map(float, line[1:])) for line in lines if line[0] == 'v'],
            [[int(corner) - 1 for corner in line[1:]] for line in lines if line[0] == 'f'])


def read_plan(path):
    """Region and charge of each triangle, by VTK's reader of text: the plan is binary, so its bytes are read here."""
    import struct
    bytes_ = open(path, 'rb').read()
    header, data = bytes_.split(b'end_header\n', 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in header.decode().split('\n') if line.startswith('element ')}
    row = struct.Struct('<B3IdI3B')
    at = counts['vertex'] * 24
    faces = [row.unpack_from(data, at + i * row.size) for i in range(counts['face'])]
    return [f[5] for f in faces], [f[4] for f in faces]


def compare_mesh(frame, path, number):
    places, faces = read_obj(path)
    assert frame['places'] == places, f'{number}: points'
    assert frame['field']['frame'] == [number] and frame['field']['part_names'] == ['Ring', 'Worm']
    polygons, parts = frame['cells']['polygon'], frame['cells']['part']
    for triangle, (corners, polygon) in enumerate(zip(frame['corners'], polygons)):
        assert set(corners) <= set(faces[polygon]) and len(set(corners)) == 3, f'{number}: triangle {triangle}'
        assert parts[triangle] == (corners[0] >= scene.RINGS * scene.AROUND)
    assert frame['cells']['triangle'] == list(range(len(polygons))) and frame['points']['vertex'] == list(range(len(places)))
    assert len(polygons) == sum(len(f) - 2 for f in faces)


def compare_pairs(frame, answer, number):
    """Each triangle is in as many pairs as the JSON lists, of all kinds together, and each kind has as many as it says."""
    kinds = {kind: frame['cells'][kind] for kind in ('crossing', 'coplanar', 'folded', 'duplicate', 'touching')}
    counts = collections.Counter(t for pair in answer['pairs'] for t in pair[:2])
    every = [sum(of_triangle) for of_triangle in zip(*kinds.values())]
    assert every == [counts[t] for t in range(len(every))], number
    assert sum(kinds['crossing']) == 2 * answer['crossing_pairs'] and sum(kinds['duplicate']) == 2 * answer['duplicate_pairs']
    assert sum(map(sum, kinds.values())) == 2 * len(answer['pairs'])
    expected = [2 if crossing else int(pairs > 0) for crossing, pairs in zip(kinds['crossing'], every)]
    assert frame['cells']['intersecting'] == expected and expected.count(2) == answer['crossing_faces'], number


def compare_depth(frame, answer, number):
    """No vertex is deeper than the JSON says, which also knows of points of edges and faces. Is the deepest point near a vertex?"""
    deepest = max(frame['points']['depth'])
    assert (deepest > 0) == (answer['depth'] > 0) and deepest <= answer['depth'], f'{number}: {deepest}, {answer["depth"]}'
    return deepest > 0.9 * answer['depth']


def compare_lists(frame, lists, number):
    """Polygons of triangles that cross, and their corners, part by part."""
    listed = {p['name']: p for f in lists['frames'] if f['frame'] == number for p in f['parts']}
    for part, name in enumerate(frame['field']['part_names']):
        chosen = [t for t, hit in enumerate(frame['cells']['intersecting']) if hit == 2 and frame['cells']['part'][t] == part]
        expected = listed.get(name, {'polygons': [], 'vertices': []})
        assert sorted({frame['cells']['polygon'][t] for t in chosen}) == expected['polygons'], f'{number} {name}'
        assert sorted({v for t in chosen for v in frame['corners'][t]}) == expected['vertices'], f'{number} {name}'


def compare_curves(curves, frame, number):
    """Curves run along triangles that cross, and have the length of their lines."""
    assert (len(curves['corners']) > 0) == any(frame['cells']['crossing']), number
    for line, length, closed in zip(curves['corners'], curves['cells']['length'], curves['cells']['closed']):
        places = [curves['places'][i] for i in line]
        steps = [sum((p - q)**2 for p, q in zip(a, b))**0.5 for a, b in zip(places, places[1:])]
        assert abs(sum(steps) - length) <= 1e-9 * length and (line[0] == line[-1]) == bool(closed), number


def run(*arguments):
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)


def main():
    tool, folder = sys.argv[1:]
    paths = scene.write_scene(folder)
    numbers = list(range(scene.FIRST, scene.FIRST + scene.COUNT))

    def name(text):
        return os.path.join(folder, text)

    plan = name('scene.plan.ply')
    run(tool, 'preprocess', paths[0], '-o', plan, '--quiet')
    run(tool, 'check', *paths, '--vtk', name('check'), '--json', name('check.json'), '--select', name('lists.json'),
        '--quiet')
    run(tool, 'replay', *paths, '--vtk', name('replay.pvd'), '--contacts', name('contacts.jsonl'), '--plan', plan,
        '--fps', '25', '--quiet')
    answers, lists = json.load(open(name('check.json'))), json.load(open(name('lists.json')))
    contacts = collections.Counter((row['frame'] + 1, vertex) for row in map(json.loads, open(name('contacts.jsonl')))
                                   for vertex in row['a'] + row['b'])
    checked = read_pvd(name('check.pvd'), numbers, numbers)
    replayed = read_pvd(name('replay.pvd'), numbers, [n / 25 for n in numbers])
    curve_files = read_pvd(name('check_curves.pvd'), numbers, numbers)
    regions, charges = read_plan(plan)
    totals, arrays = collections.Counter(), 0
    for i, number in enumerate(numbers):
        frame, again, curves = read_vtp(checked[i]), read_vtp(replayed[i]), read_vtp(curve_files[i])
        compare_mesh(frame, paths[i], number)
        compare_pairs(frame, answers['frames'][i], number)
        totals['depths of vertices'] += compare_depth(frame, answers['frames'][i], number)
        compare_lists(frame, lists, number)
        compare_curves(curves, frame, number)
        assert again['points'].pop('contacts') == [contacts[number, v] for v in range(len(frame['places']))], number
        assert again['cells'].pop('region') == regions and again['cells'].pop('charge') == charges, number
        assert again['field'].pop('TimeValue') == [number / 25] and frame['field'].pop('TimeValue') == [number]
        assert again == frame, f'{number}: check and replay differ'
        arrays += sum(len(frame[group]) for group in ('points', 'cells', 'field'))
        totals['pairs'] += len(answers['frames'][i]['pairs'])
        totals['curves'] += len(curves['corners'])
        totals['buried vertices'] += sum(depth > 0 for depth in frame['points']['depth'])
        totals['buried triangles'] += frame['cells']['buried'].count(1)
        totals['regions'] = max(regions) + 1
    totals['contacts'] = sum(contacts.values())
    assert len(glob.glob(name('*.vtp'))) == 4 * scene.COUNT and min(totals.values()) > 1, totals
    print(f'VTK {vtk.vtkVersion().GetVTKVersion()}: {arrays} arrays of {len(numbers)} frames are the same; '
          + ', '.join(f'{n} {what}' for what, n in totals.items()))


main()
