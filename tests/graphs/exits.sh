#!/usr/bin/env bash
# Bakes a graph in osgconv and lets it end, many times: none may end with a signal, though the threads that baked may
# still be at work when OpenSceneGraph unloads its plugins. Arguments: example_tank, the build's folder, how many.
set -uo pipefail
build=$2 count=${3:-500} folder=$(mktemp -d) failed=0
trap 'rm -rf "$folder"' EXIT
export OSG_LIBRARY_PATH=$build/lib:$(echo "$build"/lib/osgPlugins-*) LD_LIBRARY_PATH=$build/lib
"$1" "$folder/tank.osgt" >/dev/null
for ((run = 1; run <= count; ++run)); do
    rm -f "$folder/out.osgb"
    osgconv -O "tolerance=30cm budget=1 cache=off" "$folder/tank.osgt.tss" "$folder/out.osgb" >"$folder/log" 2>&1
    code=$?
    [ $code -eq 0 ] && [ -s "$folder/out.osgb" ] && continue
    failed=$((failed + 1))
    echo "run $run ended with $code" >&2
    tail -3 "$folder/log" >&2
done
echo "$failed of $count runs failed"
[ $failed -eq 0 ]
