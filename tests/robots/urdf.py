#!/usr/bin/env python3
"""Writes random robots in URDF: urdf.py FOLDER FIRST LAST [right], seed N as FOLDER/robots/N.urdf, with the meshes beside
them. Most are right by urdfdom; some have one thing that it refuses, or that is odd,
but for `right`: MuJoCo may crash of such."""
import os
import random
import sys

meshes = {
    'tetra.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n',
    'wedge.obj': 'v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 0 1 1\nf 1 3 2\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n'}


class Robot:
    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.seed = seed

    def may(self, likely):
        return self.chance.random() < likely

    def one(self, *things):
        return self.chance.choice(things)

    def number(self, low=-1, high=1):
        value = self.chance.uniform(low, high)
        return self.one(f'{value:.3f}', f'{value:.1f}', f'{value:.6e}', f'{value:.17g}')

    def numbers(self, count, low=-1, high=1):
        blank = self.one(' ', ' ', '  ')
        words = blank.join('0' if low < 0 and self.may(.2) else self.number(low, high) for _ in range(count))
        return f' {words} ' if self.may(.05) else words

    def origin(self):
        if self.may(.2):
            return ''
        xyz = f' xyz="{self.numbers(3)}"' if self.may(.85) else ''
        rpy = f' rpy="{self.one(self.numbers(3, -3.2, 3.2), "0 0 1.5707963267948966", "0 -1.5707963267948966 0")}"'
        return f'<origin{xyz}{rpy if self.may(.7) else ""}/>'

    def geometry(self):
        kind = self.one('box', 'cylinder', 'sphere', 'mesh')
        if kind == 'box':
            return f'<box size="{self.numbers(3, .05, .5)}"/>'
        if kind == 'cylinder':
            return f'<cylinder length="{self.number(.05, .5)}" radius="{self.number(.05, .5)}"/>'
        if kind == 'sphere':
            return f'<sphere radius="{self.number(.05, .5)}"/>'
        name = self.one('', 'package://robots/', './') + self.one(*meshes)
        scale = f' scale="{self.one(self.numbers(3, .2, 2), "1 1 -1", ".5 .5 .5")}"' if self.may(.5) else ''
        return f'<mesh filename="{name}"{scale}/>'

    def shapes(self):
        found = ''
        for kind in [self.one('collision', 'collision', 'visual') for _ in range(self.one(0, 1, 1, 2, 3))]:
            name = f' name="{kind}{self.chance.randint(0, 3)}"' if self.may(.2) else ''
            parts = [self.origin(), f'<geometry>{self.geometry()}</geometry>']
            if kind == 'visual' and self.may(.3):
                parts.append('<material name="grey"/>')
            self.chance.shuffle(parts)
            found += f'<{kind}{name}>{"".join(parts)}</{kind}>\n'
        return found

    def link(self, name):
        inertial = ''
        if self.may(.4):
            inertial = ('<inertial><origin xyz="0 0 0"/><mass value="1"/>'
                        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>')
        return f'<link name="{name}">{inertial}{self.shapes()}</link>\n'

    def limit(self, kind):
        low, high = sorted(self.chance.uniform(-2, 2) for _ in range(2))
        if self.may(.04):
            low, high = high, low
        if self.may(.04):
            high = low
        low = f' lower="{low:.17g}"' if self.may(.95) or low > 0 else ''
        high = f' upper="{high:.17g}"' if self.may(.95) or high < 0 else ''
        return f'<limit{low}{high} effort="{self.one("10", "1e3")}" velocity="1"/>'

    def joint(self, k, parent, child):
        kind = self.one('revolute', 'revolute', 'prismatic', 'continuous', 'fixed')
        if self.may(.05):
            kind = self.one('floating', 'planar')
        parts = [self.origin(), f'<parent link="{parent}"/>', f'<child link="{child}"/>']
        if self.may(.8):
            parts.append(f'<axis xyz="{self.one("1 0 0", "0 1 0", "0 0 1", "0 0 -1", "0 2 0", "1 " + self.numbers(2))}"/>')
        if kind in ('revolute', 'prismatic') or self.may(.2):
            parts.append(self.limit(kind))
        if self.may(.15):
            leader = self.chance.randint(0, self.count)
            factor = f' multiplier="{self.one("-1", "2", "0", self.number())}"' if self.may(.7) else ''
            offset = f' offset="{self.number()}"' if self.may(.4) else ''
            parts.append(f'<mimic joint="j{leader}"{factor}{offset}/>')
        if self.may(.2):
            parts.append('<dynamics damping="1" friction="0.1"/>')
        if self.may(.1):
            parts.append('<safety_controller k_velocity="1" k_position="1" soft_lower_limit="-1" soft_upper_limit="1"/>')
        self.chance.shuffle(parts)
        return f'<joint name="j{k}" type="{kind}">{"".join(parts)}</joint>\n'

    def spoil(self, written):
        """One thing that is wrong or odd."""
        a, b = self.chance.choice([
            ('size="', 'size="x '), ('radius="', 'radius="-'), ('<axis xyz="', '<axis xyz="0 0 0" a="'),
            ('<limit', '<nolimit'), (' effort="', ' eff="'), ('lower="', 'lower="nan'), ('<parent ', '<paren '),
            ('link="l1"', 'link="nobody"'), ('<box', '<capsule radius=".1" length="1"/><box'), ('<sphere', '<cone'),
            ('<collision', '<collision/><collision'), ('<geometry>', '<geometry></geometry><geometry>'),
            ('type="revolute"', 'type="screw"'), ('type="fixed"', ''), ('name="l1"', 'name="l0"'),
            ('name="j1"', 'name="j0"'), ('rpy="', 'rpy="1 '), ('<robot ', '<robot version="1.0" '),
            ('<robot ', '<robot version="1.1" '), ('<robot ', '<robot version="2.0" '), ('name="r"', ''),
            ('</robot>', '<link name="alone"/></robot>'), ('</robot>', '<joint name="more"/></robot>'),
            ('</robot>', '<gazebo reference="l0"><x/></gazebo><transmission name="t"><type>s</type></transmission></robot>'),
            ('</robot>', '<!-- an end --></robot>'), ('<robot', '<!DOCTYPE robot><robot'),
            ('filename="', 'filename="none/'), ('<mimic joint="', '<mimic joint="no'), ('xyz="', 'xyz="1e400 '),
            ('xyz="', 'xyz="+'), ('<limit', '<limit/><limit'), ('<axis', '<axis xyz="0 1 0"/><axis'),
            ('<origin', '<origin xyz="1 2 3"/><origin'), ('<mimic', '<mimic joint="j0"/><mimic'),
            ('<box', '<sphere radius=".2"/><box'), ('scale="', 'scale="0 0 0" a="'), ('scale="', 'scale="2" a="'),
            ('<axis ', '<axis rpy="0 0 1" '), ('rpy="', 'RPY="'), ('<child link="l2"', '<child link="l1"'),
            ('<parent link="l0"', '<parent link="l1"'), ('multiplier="', 'multiplier="x')])
        return written.replace(a, b, 1)

    def write(self, file):
        self.count = self.chance.randint(1, 9)
        names = [f'l{k}' for k in range(self.count + 1)]
        parts = [self.link(name) for name in names]
        for k in range(1, len(names)):
            parts.append(self.joint(k - 1, names[self.chance.randint(max(0, k - 3), k - 1)], names[k]))
        if self.may(.3):
            parts.append('<material name="grey"><color rgba=".5 .5 .5 1"/></material>\n')
        if self.may(.5):
            self.chance.shuffle(parts)
        written = f'<robot name="r">\n{"".join(parts)}</robot>\n'
        if self.may(.25) and sys.argv[4:] != ['right']:
            written = self.spoil(written)
        with open(file, 'w') as out:
            out.write(('<?xml version="1.0"?>\n' if self.may(.5) else '') + written)


folder = os.path.join(sys.argv[1], 'robots')
os.makedirs(folder, exist_ok=True)
for name, text in meshes.items():
    with open(os.path.join(folder, name), 'w') as out:
        out.write(text)
for seed in range(int(sys.argv[2]), int(sys.argv[3]) + 1):
    Robot(seed).write(os.path.join(folder, f'{seed}.urdf'))
