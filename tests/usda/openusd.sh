#!/bin/bash
# Reads all scenes, extreme ones too, and COUNT random stages with OpenUSD and here: tests/usda/openusd.sh [COUNT]. Expects a build
# that was configured with -DOSGTSS_OPENUSD=DIR, where OpenUSD is installed (24.08 was, of its base and usd parts,
# without Python and imaging). Stages whose arcs are references, payloads, variants and time samples are to be the same;
# of classes, of which Pcp leaves out those that several arcs lead to, how many are not is said.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
count=${1:-200}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$root/build/bin/tss-extreme" scenes "$work/extreme" >/dev/null 2>&1
for scene in "$root"/scenes/*.tss "$work"/extreme/*.tss; do
    "$root/build/bin/tss" convert "$scene" "$work/$(basename "$scene" .tss).usda" >/dev/null
done
echo "scenes:"
"$root/build/bin/compare_openusd" "$work"/*.usda
for arcs in rpvt i ric rpivct rpivlt rpivs; do
    for ((seed = 1; seed <= count; ++seed)); do
        python3 "$root/tests/usda/stages.py" "$seed" "$work/$arcs/$seed" "$arcs"
    done
    echo "$arcs:"
    "$root/build/bin/compare_openusd" "$work/$arcs"/*/root.usda | tail -1 || [ "$arcs" != rpvt ]
done
