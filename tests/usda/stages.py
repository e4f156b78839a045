#!/usr/bin/env python3
"""Writes a random stage of a few layers: stages.py SEED FOLDER ARCS, the first layer being FOLDER/root.usda.

ARCS: letters of what it has besides sublayers: r references, p payloads, i inherits, c classes that stronger
layers override, s specializes, v variants, l relationships, t time samples. An arc leads to a prim farther down
in its layer or to a later layer, so that none leads back."""
import os
import random
import sys

seed, folder, arcs = int(sys.argv[1]), sys.argv[2], sys.argv[3]
chance = random.Random(seed)
count = chance.randint(1, 4)
kinds = ['sub'] + [chance.choice(['sub', 'ref', 'ref']) for _ in range(count - 1)]
roots = [[f'P{i}_{k}' for k in range(chance.randint(1, 4))] for i in range(count)]
names = ['root'] + [f'l{i}' for i in range(1, count)]
schemas = ['PhysicsRigidBodyAPI', 'PhysicsCollisionAPI', 'PhysicsMassAPI', 'GeomModelAPI']


def number():
    return chance.choice(['1', '2', '3', '4.5', '6', '7', '8'])


def target(layer, at):
    """A prim farther down, or of a later layer; none where there is none."""
    found = [f'</{name}>' for name in roots[layer][at + 1:]]
    for other in range(layer + 1, count):
        if kinds[other] == 'ref':
            prim = chance.choice(roots[other])
            found += [f'@l{other}.usda@</{prim}>', f'@l{other}.usda@',
                      f'@l{other}.usda@</{prim}/{chance.choice("ab")}>']
    return chance.choice(found) if found else None


def written_arcs(layer, at):
    lines = []
    for key, likely in (('references', .35), ('payload', .15)):
        if key[0] in arcs and chance.random() < likely:
            targets = [target(layer, at) for _ in range(chance.randint(1, 2))]
            targets = list(dict.fromkeys(t for t in targets if t))
            if targets:
                lines.append(f'{chance.choice(["", "prepend ", "append "])}{key} = [{", ".join(targets)}]')
    for key, likely in (('inherits', .25), ('specializes', .15)):
        if key[0] in arcs and chance.random() < likely:
            classes = chance.sample([f'</K{layer}_{k}>' for k in range(2)], chance.randint(1, 2))
            lines.append(f'{chance.choice(["", "prepend ", "append "])}{key} = [{", ".join(classes)}]')
    return lines


def properties(layer, indent):
    text = ''.join(f'{indent}double {name} = {number()}\n' for name in 'xyzuvw' if chance.random() < .3)
    if 't' in arcs and chance.random() < .1:
        text += f'{indent}double x.timeSamples = {{ 0: {number()}, 1: {number()} }}\n'
    if 'l' in arcs and chance.random() < .3:
        paths = [f'</P{layer}_{chance.randint(0, 3)}{chance.choice(["", "/a", "/b", "/a/b"])}>'
                 for _ in range(chance.randint(1, 2))]
        change = chance.choice(['', 'prepend ', 'append ', 'delete '])
        text += f'{indent}{change}rel r = [{", ".join(dict.fromkeys(paths))}]\n'
    return text


def prim(layer, at, name, depth, indent, variants=True):
    kind = chance.choice(['def', 'def', 'def', 'over'])
    lines = written_arcs(layer, at)
    if chance.random() < .3:
        change = chance.choice(['', 'prepend ', 'prepend ', 'append ', 'delete '])
        applied = ', '.join(f'"{s}"' for s in chance.sample(schemas, chance.randint(1, 2)))
        lines.append(f'{change}apiSchemas = [{applied}]')
    if chance.random() < .04:
        lines.append('active = false')
    sets = variants and 'v' in arcs and chance.random() < .25
    if sets or 'v' in arcs and chance.random() < .1:
        lines.append(f'variants = {{ string v = "{chance.choice(["one", "two"])}" }}')
    elif depth == 0:
        lines.append('variants = { string other = "" }')
    if sets:
        lines.append(f'{chance.choice(["", "prepend ", "append "])}variantSets = "v"')
    type_name = chance.choice(['Xform ', 'Scope ', 'Cube ', '']) if kind == 'def' else ''
    text = f'{indent}{kind} {type_name}"{name}" (\n' + ''.join(f'{indent}    {line}\n' for line in lines)
    text += f'{indent})\n{indent}{{\n' + properties(layer, indent + '    ')
    for child in 'ab':
        if depth < 3 and chance.random() < .5:
            text += prim(layer, at, child, depth + 1, indent + '    ', variants)
    if sets:
        text += f'{indent}    variantSet "v" = {{\n'
        for variant in ('one', 'two'):
            if variant == 'two' and chance.random() < .15:
                continue
            own = written_arcs(layer, at) if chance.random() < .4 else []
            head = '(\n' + ''.join(f'{indent}            {line}\n' for line in own) + f'{indent}        ) ' if own else ''
            text += f'{indent}        "{variant}" {head}{{\n' + properties(layer, indent + '            ')
            if depth < 3 and chance.random() < .4:
                text += prim(layer, at, chance.choice('ab'), depth + 1, indent + '            ', False)
            text += f'{indent}        }}\n'
        text += f'{indent}    }}\n'
    return text + f'{indent}}}\n'


def class_of(layer, k):
    text = f'class "K{layer}_{k}"\n{{\n' + properties(layer, '    ')
    if chance.random() < .5:
        text += f'    def Scope "{chance.choice("ab")}"\n    {{\n' + properties(layer, '        ') + '    }\n'
    return text + '}\n'


os.makedirs(folder, exist_ok=True)
for layer in range(count):
    head = [f'defaultPrim = "{roots[layer][0]}"'] if chance.random() < .9 else []
    below = [f'@l{other}.usda@' for other in range(1, count) if kinds[other] == 'sub']
    if layer == 0 and below:
        head.append(f'subLayers = [{", ".join(below)}]')
    text = '#usda 1.0\n' + ('(\n' + ''.join(f'    {line}\n' for line in head) + ')\n' if head else '')
    for at, name in enumerate(roots[layer]):
        text += prim(layer, at, name, 0, '')
    if layer > 0 and kinds[layer] == 'sub':
        for name in roots[0]:
            if chance.random() < .6:
                text += prim(layer, 99, name, 1, '')
    text += class_of(layer, 0) + class_of(layer, 1)
    if 'c' in arcs:
        for other in range(layer + 1, count):
            for k in range(2):
                if chance.random() < .4:
                    text += class_of(other, k)
    with open(os.path.join(folder, names[layer] + '.usda'), 'w') as file:
        file.write(text)
