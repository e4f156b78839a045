#!/usr/bin/env bash
# Builds the fuzzers of the readers of scenes, of robots and of USD (preset fuzz) and runs all for a time, side by side, with
# address and undefined-behaviour sanitizers. What they find stays in build-fuzz/run/found-*, what they learn in build-fuzz/run/.
set -euo pipefail
if [ $# -ne 1 ] || ! [[ "$1" =~ ^[0-9]+$ ]]; then
    echo "usage: tests/fuzz/run.sh SECONDS" >&2
    exit 2
fi
seconds=$1
cd "$(dirname "$0")/../.."
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)"
mkdir -p build-fuzz/run
cd build-fuzz/run
../bin/fuzz_seeds .
mkdir -p urdf mjcf usda
cp ../../examples/arm/arm.urdf urdf/
cp ../../examples/arm/arm.xml mjcf/
cp ../../examples/arm/*.usda ../../tests/scene/everything.usda usda/

declare -A running
declare -A words=([json]=words [cbor]=words [urdf]=../../tests/fuzz/robot.words [mjcf]=../../tests/fuzz/robot.words [usda]=../../tests/fuzz/usda.words)
for encoding in json cbor urdf mjcf usda; do
    mkdir -p "learnt-$encoding"
    "../bin/fuzz_$encoding" "learnt-$encoding" "$encoding" -dict="${words[$encoding]}" -max_total_time="$seconds" -timeout=10 \
        -malloc_limit_mb=256 -max_len=40000 -artifact_prefix="found-$encoding-" -print_final_stats=1 \
        >"$encoding.log" 2>&1 &
    running[$encoding]=$!
done
failed=()
for encoding in json cbor urdf mjcf usda; do
    wait "${running[$encoding]}" || failed+=("$encoding")
    printf '%s: ' "$encoding"
    grep -E 'SUMMARY|ERROR|number_of_executed_units' "$encoding.log" | tail -n 3
done
# Of each that failed: what its log says of it, and the bytes, so that another machine can run them.
for encoding in ${failed[@]+"${failed[@]}"}; do
    echo "== $encoding"
    grep -vE '^#[0-9]+|NEW_FUNC|# Uses' "$encoding.log" | tail -n 60 | cut -c 1-300
    for found in found-"$encoding"-*; do
        [ -f "$found" ] || continue
        echo "base64 of $found:"
        head -c 6000 "$found" | base64
    done
done
if [ ${#failed[@]} -gt 0 ]; then
    echo "FAILED: ${failed[*]}; what was found is in build-fuzz/run/found-*"
    exit 1
fi
echo "PASSED: nothing found in $seconds s of each"
