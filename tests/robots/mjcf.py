#!/usr/bin/env python3
"""Writes random models in MJCF: mjcf.py FOLDER FIRST LAST, seed N as FOLDER/N/robot.xml with its meshes and what
it includes. Most are right by MuJoCo 2.2.2; some have one thing that it refuses."""
import math
import os
import random
import struct
import sys


def text(numbers):
    return ' '.join(f'{n:.6g}' for n in numbers)


class Model:
    def __init__(self, seed, folder):
        self.chance = random.Random(seed)
        self.folder = folder
        self.bodies, self.geoms, self.joints = [], [], []
        self.classes = []
        self.meshes = []
        self.count = 0
        self.budget = self.chance.randint(2, 9)
        self.included = 0
        self.field = False
        self.class_turn = self.one('', '', '', 'axisangle', 'euler', 'xyaxes', 'zaxis')

    # Chance.
    def may(self, likely):
        return self.chance.random() < likely

    def one(self, *things):
        return self.chance.choice(things)

    def number(self, low=-1, high=1):
        return round(self.chance.uniform(low, high), self.one(1, 3))

    def length(self):
        return max(0.01, self.number(0.02, 0.4))

    def vector(self, zeros=.2):
        return [0 if self.may(zeros) else self.number() for _ in range(3)]

    def direction(self):
        if self.may(.4):
            k, sign = self.chance.randrange(3), self.one(1, -1, 2)
            return [sign if i == k else 0 for i in range(3)]
        found = self.vector()
        return found if any(found) else [0, 0, 1]

    def angle(self, most=180):
        degrees = self.one(90, -90, 180, 45, self.number(-most, most) * 1) if most == 180 else self.number(-most, most)
        return degrees if self.degrees else round(math.radians(degrees), 7)

    # Attributes.
    def turn(self, own=True):
        # Of two forms, one of a class, versions of MuJoCo take one or the other, but for quat.
        kind = self.one('', 'quat', self.class_turn if own else self.one('quat', self.class_turn))
        if not self.class_turn:
            kind = self.one('', 'quat', 'axisangle', 'euler', 'xyaxes', 'zaxis') if own else ''
        if kind == 'quat':
            return {'quat': text([self.one(1, self.number())] + self.vector() if self.may(.9) else [0, 1, 0, 0])}
        if kind == 'axisangle':
            return {'axisangle': text(self.direction() + [self.angle()])}
        if kind == 'euler':
            return {'euler': text(self.angle() for _ in range(3))}
        if kind == 'xyaxes':
            x = self.direction()
            y = [x[1] - x[2] + .3, x[2] - x[0], x[0] - x[1] + self.number()]
            return {'xyaxes': text(x + y)}
        if kind == 'zaxis':
            return {'zaxis': text(self.direction())}
        return {}

    def place(self, likely=.7, own=True):
        place = {'pos': text(self.vector())} if self.may(likely) else {}
        return {**place, **(self.turn(own) if self.may(likely) else {})}

    def bits(self):
        found = {}
        for name in ('contype', 'conaffinity'):
            if self.may(.3):
                found[name] = self.one('0', '0', '1', '2', '3', ' 0', '00')
        return found

    def some_class(self, likely=.25):
        return {'class': self.chance.choice(self.classes)} if self.classes and self.may(likely) else {}

    def joint(self, own=True):
        kind = self.one('hinge', 'hinge', 'hinge', 'slide', 'ball')
        found = {} if kind == 'hinge' and self.may(.5) else {'type': kind}
        if self.may(.6):
            found['pos'] = text(self.vector())
        if self.may(.7):
            found['axis'] = text(self.direction())
        if self.may(.8 if own else .3):
            if kind == 'slide':
                low = self.number()
                found['range'] = text([low, low + self.length()])
            else:
                most = abs(self.angle(170)) + .1
                found['range'] = text([0 if kind == 'ball' else -most * self.chance.random(), most])
            if self.may(.06):
                found['range'] = self.one('0 0', '.5 .2')
        if self.may(.4 if 'range' in found else .05):
            found['limited'] = self.one('true', 'true', 'false', 'auto')
        if 'range' in found and not self.auto:
            found['limited'] = self.one('true', 'true', 'false')
        if self.may(.25):
            found['ref'] = text([self.angle(30)])
        if self.may(.2):
            found[self.one('damping', 'armature', 'stiffness')] = '0.1'
        if self.may(.1):
            found['group'] = '1'
        return found

    def sizes(self, kind):
        count = {'sphere': 1, 'capsule': 2, 'cylinder': 2, 'box': 3, 'ellipsoid': 3}[kind]
        if self.may(.15):
            count = self.chance.randint(count, 3)
        elif self.may(.05) and not self.discards:  # else MuJoCo may not look at it
            count = 1
        return text(self.length() for _ in range(count))

    def geom(self, own=True, world=False):
        kinds = ['sphere', 'capsule', 'cylinder', 'box', 'ellipsoid'] + (['mesh'] if self.meshes else [])
        kind = self.chance.choice(kinds + (['plane', 'plane'] if world else [])
                                  + (['hfield'] if self.field and world else []))
        found = {} if kind == 'sphere' and self.may(.6) else {'type': kind}
        if kind == 'plane':
            found['size'] = '1 1 .1'
        elif kind == 'hfield':
            found['hfield'] = 'hills'
        elif kind == 'mesh':
            found['mesh'] = self.chance.choice(self.meshes)
        elif self.may(.97 if own else .5):
            found['size'] = self.sizes(kind if 'type' in found else 'box')  # a class may say what it is
        if kind in ('capsule', 'cylinder', 'box', 'ellipsoid') and self.may(.3 if own else .02):
            start, end = self.vector(), self.vector()
            if self.may(.3):  # along an axis
                k = self.chance.randrange(3)
                end = [start[i] + (self.one(-.5, .5) if i == k else 0) for i in range(3)]
            found['fromto'] = text(start + end)
        if kind not in ('mesh', 'plane', 'hfield') and self.meshes and self.may(.03):
            found['mesh'] = self.chance.choice(self.meshes)  # fitted to it
        found.update(self.turn(own) if 'fromto' in found else self.place(.6 if own else .1, own))
        found.update(self.bits() if self.may(.6 if own else .25) else {})
        if self.may(.3):
            found['rgba'] = text(abs(n) for n in self.vector() + [1])
        if self.may(.2):
            found[self.one('group', 'condim')] = '1'
        if self.may(.2):
            found['density'] = '500'
        return found

    # Elements.
    def element(self, name, attributes, inside=None):
        words = ''.join(f' {key}="{value}"' for key, value in attributes.items())
        if not inside:
            return f'<{name}{words}/>\n'
        return f'<{name}{words}>\n{inside}</{name}>\n'

    def new_name(self, kind, names):
        self.count += 1
        name = f'{kind}{self.count}' + (self.one('.x', ' y', '-z') if self.may(.1) else '')
        names.append(name)
        return {'name': name}

    def apart(self, written):
        """In a file of its own, now and then."""
        if not written or not self.may(.06) or self.included > 3:
            return written
        self.included += 1
        name = f'part{self.included}.xml'
        root = self.one('mujocoinclude', 'mujoco')
        with open(os.path.join(self.folder, name), 'w') as file:
            file.write(f'<{root}>\n{written}</{root}>\n')
        return f'<include file="{name}"/>\n'

    def default(self, depth, name):
        inside = ''
        if self.may(.6):
            inside += self.element('geom', self.geom(False))
        if self.may(.6):
            inside += self.element('joint', self.joint(False))
        if self.may(.3):
            inside += self.element('mesh', {'scale': text(self.scale())})
        if self.may(.2):
            inside += self.element('site', {'size': '.01'})
        if self.may(.2):
            inside += self.element('pair', {'margin': '0'})
        for _ in range(self.chance.randint(0, 2) if depth < 2 else 0):
            self.count += 1
            below = f'class{self.count}'
            inside += self.default(depth + 1, below)
            self.classes.append(below)
        return self.element('default', {'class': name} if name else {}, inside or self.element('site', {}))

    def scale(self):
        if self.may(.3):
            return [self.number(.2, 1.5) + .05] * 3
        return [(self.number(.2, 1.5) + .05) * (-1 if self.may(.15) else 1) for _ in range(3)]

    def body(self, depth, top):
        self.budget -= 1
        attributes = self.new_name('body', self.bodies) if self.may(.85) else {}
        attributes.update(self.place())
        if self.classes and self.may(.25):
            attributes['childclass'] = self.chance.choice(self.classes)
        inside = ''
        if top and self.may(.04):
            attributes['mocap'] = 'true'
        elif top and self.may(.1):
            inside += self.one('<freejoint/>\n', '<freejoint name="free"/>\n', '<joint type="free"/>\n')
        else:
            for k in range(self.one(0, 1, 1, 1, 1, 2, 3), 0, -1):
                name = self.new_name('joint', self.joints) if self.may(.7) else {}
                joint = {**name, **self.some_class(), **self.joint()}
                if joint.get('type') == 'ball' and k > 1:
                    continue  # none may turn after it
                inside += self.apart(self.element('joint', joint))
        geoms = self.one(0, 1, 1, 1, 2, 3)
        if geoms == 0 or self.may(.5):
            inside += self.element('inertial', {'pos': '0 0 0', 'mass': '1', 'diaginertia': '1 1 1'})
        for _ in range(geoms):
            name = self.new_name('geom', self.geoms) if self.may(.6) else {}
            inside += self.apart(self.element('geom', {**name, **self.some_class(), **self.geom()}))
        if self.may(.2):
            inside += self.element(self.one('site', 'camera', 'light'), {'pos': '0 0 1'})
        while self.budget > 0 and depth < 5 and self.may(.6):
            inside += self.body(depth + 1, False)
        return self.apart(self.element('body', attributes, inside))

    # Meshes.
    def corners(self):
        """A box or a tetrahedron, closed and outward."""
        size, middle = [self.number(.1, .6) + .05 for _ in range(3)], self.vector()
        if self.may(.5):
            points = [[middle[i] + size[i] * (k >> i & 1) for i in range(3)] for k in range(8)]
            faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
                     (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
        else:
            points = [middle] + [[middle[i] + (size[i] if i == k else 0) for i in range(3)] for k in range(3)]
            faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        return points, faces

    def write_mesh(self, name, folder):
        points, faces = self.corners()
        path = os.path.join(self.folder, folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if name.endswith('.obj'):
            with open(path, 'w') as file:
                file.writelines(f'v {text(p)}\n' for p in points)
                file.writelines(f'f {" ".join(str(k + 1) for k in f)}\n' for f in faces)
        elif name.endswith('.stl'):
            with open(path, 'wb') as file:
                file.write(b'\0' * 80 + struct.pack('<I', len(faces)))
                for f in faces:
                    file.write(struct.pack('<12fH', 0, 0, 0, *(x for k in f for x in points[k]), 0))
        else:
            with open(path, 'wb') as file:
                file.write(struct.pack('<4i', len(points), 0, 0, len(faces)))
                for p in points:
                    file.write(struct.pack('<3f', *p))
                for f in faces:
                    file.write(struct.pack('<3i', *f))

    def assets(self, compiler):
        inside = ''
        for k in range(self.one(0, 0, 1, 2, 3)):
            name = f'part.{k}.' + self.one('obj', 'stl', 'msh')
            folder = compiler.get('meshdir', '.')
            if compiler.get('strippath') == 'true':
                written = 'else/where/' + name
            else:
                written = self.one(name, 'deep/' + name)
            self.write_mesh(os.path.basename(written) if compiler.get('strippath') == 'true' else written, folder)
            attributes = {'file': written}
            called = name.rsplit('.', 1)[0]
            if self.may(.6):
                called = attributes['name'] = f'mesh{k}'
            if self.may(.5):
                attributes['scale'] = text(self.scale())
            if self.may(.3):
                attributes['refpos'] = text(self.vector())
            if self.may(.3):
                attributes['refquat'] = text([1] + self.vector())
            attributes.update(self.some_class())
            self.meshes.append(called)
            inside += self.element('mesh', attributes)
        if self.may(.05):
            self.meshes.append('inline')
            inside += self.element('mesh', {'name': 'inline', 'vertex': '0 0 0 1 0 0 0 1 0 0 0 1'})
        if self.may(.1):
            self.field = True
            inside += self.element('hfield', {'name': 'hills', 'nrow': '3', 'ncol': '3', 'size': '1 1 .1 .1'})
        return self.apart(self.element('asset', {}, inside)) if inside else ''

    def compiler(self):
        self.auto = self.may(.85)
        found = {'autolimits': 'true' if self.auto else 'false'}
        unit = self.one('', 'degree', 'radian')
        self.degrees = unit != 'radian'
        if unit:
            found['angle'] = unit
        if self.may(.4):
            found['eulerseq'] = ''.join(self.one(*'xyzXYZ') for _ in range(3))
        if self.may(.3):
            found['meshdir'] = self.one('meshes', 'meshes/', 'a/b')
        for name, likely in (('strippath', .2), ('balanceinertia', .2), ('fitaabb', .2), ('discardvisual', .1)):
            if self.may(likely):
                found[name] = self.one('true', 'false')
        self.discards = found.get('discardvisual') == 'true'
        if self.may(.2):
            found['inertiafromgeom'] = self.one('true', 'auto')
        if self.may(.1):
            found['settotalmass'] = '3'
        if self.may(.3):
            found['coordinate'] = 'local'
        return found

    def two(self, names):
        return self.chance.sample(names, 2)

    def rest(self):
        found = ''
        inside = ''
        for _ in range(self.one(0, 0, 1, 2, 3)):
            if len(self.bodies) > 1:
                a, b = self.two(self.bodies + ['world'] * (self.may(.1)))
                inside += self.element('exclude', {'body1': a, 'body2': b})
        for _ in range(self.one(0, 0, 1, 2)):
            if len(self.geoms) > 1:
                a, b = self.two(self.geoms)
                inside += self.element('pair', {'geom1': a, 'geom2': b})
        if inside:
            found += self.element('contact', {}, inside)
        inside = ''
        if len(self.joints) > 1 and self.may(.2):
            a, b = self.two(self.joints)
            inside += self.element('joint', {'joint1': a, 'joint2': b, 'polycoef': '0 .5 0 0 0'})
        if len(self.bodies) > 1 and self.may(.15):
            a, b = self.two(self.bodies)
            inside += self.element('weld', {'body1': a, 'body2': b})
        if self.bodies and self.may(.1):
            inside += self.element('connect', {'body1': self.bodies[0], 'anchor': '0 0 0'})
        if inside:
            found += self.element('equality', {}, inside)
        if self.joints and self.may(.2):
            found += self.element('actuator', {}, self.element('motor', {'joint': self.joints[0]}))
        return found

    def spoil(self, written):
        """One thing that is wrong or odd."""
        a, b = self.chance.choice([
            ('<geom ', '<geom contyp="0" '), ('size="', 'size="x '), ('<joint ', '<joint axis="0 0 0" '),
            ('type="box"', 'type="boxx"'), ('<worldbody>', '<worldbody><body name="body1"/><body name="body1"/>'),
            ('class="', 'class="no'), ('<body ', '<body pos="1 2" '), ('euler="', 'euler="0 '),
            ('<worldbody>', '<compiler coordinate="global"/><worldbody>'), ('mesh="', 'mesh="no'),
            ('quat="', 'quat="0 0 0 0" x="'), ('<worldbody>', '<worldbody><joint/>'), ('body1="', 'body1="no'),
            ('geom1="', 'geom1="no'), ('range="', 'range="1 '), ('zaxis="', 'zaxis="0 0 0" a="'),
            ('<geom ', '<geom size="-1" '), ('<geom ', '<geom type="plane" size="1 1 1" '), ('limited="', 'limited="x'),
            ('</worldbody>', '<body><geom size="1"/><joint limited="true"/></body></worldbody>'),
            ('</worldbody>', '<body><geom size="1"/><joint type="slide" range="2 1" limited="true"/></body></worldbody>'),
            ('</worldbody>', '<body><geom size="1" type="box"/></body></worldbody>'),
            ('</worldbody>', '<body><body><geom size="1"/><freejoint/></body></body></worldbody>'),
            ('</worldbody>', '<body><geom type="sphere" size=".1" fromto="0 0 0 1 1 1"/></body></worldbody>'),
            ('</worldbody>', '<body><geom type="capsule" size=".1" fromto="1 1 1 1 1 1"/></body></worldbody>')])
        return written.replace(a, b, 1)

    def write(self):
        os.makedirs(self.folder, exist_ok=True)
        compiler = self.compiler()
        head = ''
        if self.may(.2):  # the later one counts
            head = self.element('compiler', {'angle': self.one('degree', 'radian'), 'eulerseq': 'zxy'})
            compiler.setdefault('angle', 'degree' if self.degrees else 'radian')
        head += self.apart(self.element('compiler', compiler))
        if self.may(.3):
            head += self.element('option', {'timestep': '.002'})
        top = self.one('', '', 'main', 'top')
        defaults = self.default(0, top) if self.may(.7) else ''
        if defaults and self.may(.1):
            defaults += self.element('default', {}, self.element('geom', {'conaffinity': '0'}))
        defaults = self.apart(defaults)
        assets = self.assets(compiler)
        parts = []
        for _ in range(self.one(1, 1, 1, 2)):
            inside = ''
            for _ in range(self.one(0, 0, 1, 2)):
                name = self.new_name('geom', self.geoms) if self.may(.5) else {}
                inside += self.element('geom', {**name, **self.some_class(), **self.geom(world=True)})
            while not inside.count('<body') and 'include' not in inside or self.budget > 0 and self.may(.4):
                inside += self.body(1, True)
            parts.append(self.element('worldbody', {}, inside))
        sections = [head, defaults, assets] + parts
        if self.may(.2):
            self.chance.shuffle(sections)
        written = ''.join(sections) + self.rest()
        if self.may(.12):
            written = self.spoil(written)
        with open(os.path.join(self.folder, 'robot.xml'), 'w') as file:
            file.write(f'<mujoco model="m">\n{written}</mujoco>\n')


for seed in range(int(sys.argv[2]), int(sys.argv[3]) + 1):
    Model(seed, os.path.join(sys.argv[1], str(seed))).write()
