#!/usr/bin/env bash
# Bakes the pairs of a scene one by one, as many at a time as the machine has cores, with GNU parallel, and merges the
# parts. The result has the same bytes as `tss bake SCENE -o OUT OPTIONS` in one go.
# usage: examples/farm/parallel.sh SCENE.tss OUT.tss [options of tss bake]
# With --sshlogin in PARALLEL (the environment variable that GNU parallel reads) it spreads over machines that share
# this folder.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '4p' "$0" >&2; exit 2; }
tss=${TSS:-$(dirname "$0")/../../build/bin/tss}
scene=$1 out=$2
shift 2
parts=$(mktemp -d -p "$(dirname "$out")" parts.XXXXXX)
trap 'rm -rf "$parts"' EXIT

# One thread a bake: the cores are busy with other pairs.
"$tss" info "$scene" --paths |
    parallel -q --halt now,fail=1 "$tss" bake "$scene" -o "$parts/{#}.tss" --pair {} --threads 1 --quiet "$@"
"$tss" merge "$scene" "$parts"/*.tss -o "$out"
