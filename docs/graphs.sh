#!/usr/bin/env bash
# Tries graphs that others made as X.tss and prints a row of the table of docs/OSG.md for each: what is found in it,
# what is baked, how long the whole load takes, and whether its first picture is that of X, byte for byte.
#   docs/graphs.sh FILE ["OPTIONS" [FILE ...]]    a file that OpenSceneGraph reads; OPTIONS: words with blanks or =
#   docs/graphs.sh OpenSceneGraph-Data/*.osg*
# SECONDS_EACH=300 in the environment: what takes longer is ended and named.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
export OSG_LIBRARY_PATH=$root/build/lib:$(echo "$root"/build/lib/osgPlugins-*) LD_LIBRARY_PATH=$root/build/lib
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
limit=${SECONDS_EACH:-300}

picture() { # FILE OUT OPTIONS: the first picture; the library path finds textures beside the file
    timeout "$limit" "$root/build/bin/tss-render" "$1" -o "$2" --frames 1 --size 640x480 --quiet --options "$3" >>"$work/log" 2>&1
}

row() { # FILE OPTIONS
    local file=$1 options=$2 start seconds code same joints
    rm -f "$work"/*
    export OSG_FILE_PATH=$(dirname "$file")
    start=$(date +%s.%N)
    timeout "$limit" osgconv -O "$options cache=$work/cache.tss" "$file.tss" "$work/out.tss" >"$work/log" 2>&1
    code=$?
    seconds=$(echo "$(date +%s.%N) $start" | awk '{ printf "%.1f", $1 - $2 }')
    if ! [ -s "$work/out.tss" ]; then
        echo "| $(basename "$file") | \`$options\` | not loaded (exit $code) | | | | $seconds | |"
        return
    fi
    same=differ
    picture "$file" "$work/plain.png" "" && picture "$file.tss" "$work/tss.png" "$options cache=$work/cache.tss" &&
        cmp -s "$work/plain.png" "$work/tss.png" && same=same
    [ -s "$work/tss.png" ] || same="not drawn"
    [ -s "$work/plain.png" ] || same="not drawn by itself"
    joints=$(grep -oE '"typeName": ?"Physics[A-Za-z]*Joint"' "$work/out.tss" | wc -l)
    "$root/build/bin/tss" info --json "$work/out.tss" 2>/dev/null | python3 -c '
import json, sys
name, options, joints, seconds, same, warnings = sys.argv[1:]
pairs = json.load(sys.stdin)["pairs"]
tables = sum(p["baked"] and not p["neverCollides"] for p in pairs)
proofs = sum(p["neverCollides"] for p in pairs)
print("| %s | `%s` | %s | %d | %d | %d | %s | %s | %s |" %
      (name, options, joints, len(pairs), tables, proofs, seconds, same, warnings))' \
        "$(basename "$file")" "$options" "$joints" "$seconds" "$same" "$(grep -c '^osgTSS: ' "$work/log")"
    [ -z "${NOTES:-}" ] || grep '^osgTSS: ' "$work/log" >&2
}

echo "| graph | options | joints | pairs | tables | proofs | seconds | first picture | lines said |"
echo "|---|---|---|---|---|---|---|---|---|"
file=
for word in "$@"; do
    if [ -e "$word" ]; then
        [ -z "$file" ] || row "$file" "budget=5"
        file=$word
    else
        row "$file" "$word"
        file=
    fi
done
[ -z "$file" ] || row "$file" "budget=5"
