#!/usr/bin/env bash
# Tries graphs that others made as X.tss and prints the tables of docs/OSG.md: what is found in each, what is baked, how
# long the whole load takes, and whether at rest its picture is that of X, byte for byte; then, of those with tables, how
# often parts are in each other while they move, by FCL on the triangles, without osgTSS and with it.
#   docs/graphs.sh FOLDER ...    the graphs of docs/graphs.txt that are below the folders, with the options there, and
#                                all others that lie in the folders themselves, with budget=5
#   docs/graphs.sh FILE ["OPTIONS" [FILE ...]]    any file that OpenSceneGraph reads; OPTIONS: words with blanks or =
# In the environment: SECONDS_EACH=600: what takes longer is ended and named; FRAMES=200, 0: no second table; NOTES=1:
# what is said on loading goes to stderr.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
export OSG_LIBRARY_PATH=$root/build/lib:$(echo "$root"/build/lib/osgPlugins-*) LD_LIBRARY_PATH=$root/build/lib
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
limit=${SECONDS_EACH:-600}

picture() { # FILE OUT OPTIONS: the picture at rest; the library path finds textures beside the file
    timeout "$limit" "$root/build/bin/tss-render" "$1" -o "$2" --rest --frames 1 --size 640x480 --quiet --options "$3" >>"$work/log" 2>&1
}

contacts() { # FILE OPTIONS
    timeout "$limit" "$root/build/bin/graph_contacts" "$1" "$2 cache=$work/cache.tss" "${FRAMES:-200}" 2>>"$work/said" |
        sed -n "s| cache=$work/cache.tss||; /^|/p" >>"$work/contacts"
    [ "${PIPESTATUS[0]}" -le 1 ] || echo "| $(basename "$1") | \`$2\` | not played |" >>"$work/contacts"
}

row() { # FILE OPTIONS
    local file=$1 options=$2 start seconds code same joints
    rm -f "$work"/{cache.tss,log,out.tss,plain.png,tss.png}
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
name, options, joints, seconds, same, said = sys.argv[1:]
pairs = json.load(sys.stdin)["pairs"]
tables = sum(p["baked"] and not p["neverCollides"] for p in pairs)
proofs = sum(p["neverCollides"] for p in pairs)
print("| %s | `%s` | %s | %d | %d | %d | %s | %s | %s |" %
      (name, options, joints, len(pairs), tables, proofs, seconds, same, said))
sys.exit(tables == 0)' "$(basename "$file")" "$options" "$joints" "$seconds" "$same" "$(grep -c '^osgTSS: ' "$work/log")" &&
        [ "${FRAMES:-200}" -gt 0 ] && contacts "$file" "$options"
    [ -z "${NOTES:-}" ] || grep '^osgTSS: ' "$work/log" >&2
}

folders=()
words=()
for word in "$@"; do
    if [ -d "$word" ]; then folders+=("$word"); else words+=("$word"); fi
done

echo "| graph | options | joints | pairs | tables | proofs | seconds | picture | lines said |"
echo "|---|---|---|---|---|---|---|---|---|"
if [ ${#folders[@]} -gt 0 ]; then
    while read -r name options; do
        while read -r file; do row "$file" "$options"; done < <(find "${folders[@]}" -name "$name")
    done <"$root/docs/graphs.txt"
    while read -r file; do
        grep -q "^$(basename "$file") " "$root/docs/graphs.txt" || row "$file" "budget=5"
    done < <(find "${folders[@]}" -maxdepth 1 -type f \( -name "*.osg" -o -iname "*.osg[tbx]" -o -iname "*.ive" \) | sort)
fi
file=
for word in "${words[@]}"; do
    if [ -e "$word" ]; then
        [ -z "$file" ] || row "$file" "budget=5"
        file=$word
    else
        row "$file" "$word"
        file=
    fi
done
[ -z "$file" ] || row "$file" "budget=5"

[ -s "$work/contacts" ] || exit 0
echo
echo "| graph | options | pairs | tables | proofs | left out | in contact at rest | in contact, without | with osgTSS | ms an update, without | with osgTSS | at most |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
cat "$work/contacts"
cat "$work/said" >&2
