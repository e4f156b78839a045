"""Plays OpenUSD's own characters of its test of baked skinning and says how far each mesh is from where OpenUSD has it:
tests/usda/skel.py TSS OPENUSD, the command and a checkout of github.com/PixarAnimationStudios/OpenUSD. A mesh of dual
quaternions is to be there to rounding; one of linear blending is off where the weights of joints that turn mix."""
import glob, math, os, re, subprocess, sys, tempfile

FOLDER = "pxr/usd/usdSkel/testenv/testUsdSkelBakeSkinning"


def baked(path):
    """{mesh: {time: points}} of a stage whose points are time samples."""
    meshes, name, mesh = {}, None, None
    for line in open(path):
        if found := re.match(r'\s*(?:def|over) \w* ?"(\w+)"', line):
            name = found.group(1)
        sample = re.match(r"\s*(-?[\d.]+): \[(.*)\],?\s*$", line)
        if "timeSamples" in line:
            mesh = name if "points.timeSamples" in line else None
        elif sample and mesh:
            n = [float(x) for x in re.findall(r"[-+\d.eE]+", sample.group(2))]
            meshes.setdefault(mesh, {})[float(sample.group(1))] = [n[i : i + 3] for i in range(0, len(n), 3)]
    return meshes


def played(path):
    """{mesh: points} of an OBJ of groups."""
    meshes, points = {}, None
    for line in open(path):
        if line.startswith("g "):
            points = meshes.setdefault(line.split()[1], [])
        elif line.startswith("v "):
            points.append([float(x) for x in line.split()[1:4]])
    return meshes


def main(tss, openusd):
    off = 0
    for kind in ("dqs", "lbs"):
        with tempfile.TemporaryDirectory() as work:
            scene, ready = f"{work}/scene.tss", f"{work}/baked.tss"
            for command in (
                [tss, "make", f"{openusd}/{FOLDER}/{kind}.usda", "-o", scene],
                [tss, "bake", scene, "-o", ready],
                [tss, "play", ready, "-o", f"{work}/r.csv", "--mesh-out", f"{work}/f_%04d.obj"],
            ):
                subprocess.run(command + ["--quiet"], check=True, stdout=subprocess.DEVNULL)
            frames = [played(f) for f in sorted(glob.glob(f"{work}/f_*.obj"))]
        for mesh, times in baked(f"{openusd}/{FOLDER}/baseline/{kind}.baked.usda").items():
            if mesh not in frames[0]:
                continue
            worst = 0
            for time, points in times.items():
                size = math.dist([max(c) for c in zip(*points)], [min(c) for c in zip(*points)])
                near = frames[int(time) - 1][mesh]  # the test's first time code is 1
                worst = max(worst, max(min(math.dist(p, q) for q in near) for p in points) / size)
            print(f"{kind}: {mesh} {100 * worst:.3g} % of its size")
            off = max(off, worst if kind == "dqs" else 0)
    return 0 if off < 1e-6 else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
