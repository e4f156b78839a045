#!/usr/bin/env bash
# A tank that knows nothing of osgTSS, moved for 200 frames: its gun goes through its hull in some of them, and in
# none with osgTSS. Arguments: example_tank, graph_contacts, a folder to write in.
set -euo pipefail
file=$3/contacts.osgt
"$1" "$file" >/dev/null
row=$("$2" "$file" "pairs=all tolerance=2cm cache=off" 200)
echo "$row"
free=$(echo "$row" | awk -F'|' '{ print $9 }')
[ "$free" -gt 0 ] || { echo "nothing is in contact without osgTSS either" >&2; exit 1; }
