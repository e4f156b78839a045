#!/usr/bin/env bash
# The arrows between folders: fails where a source includes what its folder may not lean on (docs/EXTENDING.md).
set -euo pipefail
cd "$(dirname "$0")/.."

# folder: the folders of bake/ that it may include, besides itself.
declare -A may=(
    [base]=""
    [geometry]="base"
    [motion]="base geometry"
    [spheres]="base geometry"
    [table]="base geometry motion spheres"
    [search]="base geometry motion spheres table"
    [reduce]="base motion search spheres table"
    [verify]="base geometry motion spheres table"
    [bind]="base geometry motion"
    [respond]="base bind geometry motion spheres table"
    [model]="base geometry motion spheres table"
    [character]="base geometry model motion"
    [play]="base bind geometry model motion respond spheres table"
    [fill]="base geometry motion search spheres table"
    [pipeline]="base bind fill geometry model motion play reduce respond search spheres table"
    [check]="base geometry model motion pipeline play search spheres table verify"
    [scene]="base geometry model motion spheres table"
    [robot]="base character geometry model motion scene search spheres table"
    [usd]="base character geometry model motion robot scene spheres table"
    [compare]="base geometry motion spheres table"
    [report]="base compare geometry model motion pipeline play reduce respond scene search spheres table verify"
    [tool]="base check geometry model motion pipeline play report respond robot scene spheres table usd verify"
)
wrong=0
for folder in bake/*/; do
    name=$(basename "$folder")
    if [ -z "${may[$name]+known}" ]; then
        echo "bake/$name: expected a line for it in tests/layers.sh"
        wrong=1
        continue
    fi
    while IFS=: read -r file include; do
        target=${include#*\"bake/}
        target=${target%%/*}
        [[ " $name ${may[$name]} " == *" $target "* ]] || {
            echo "$file: bake/$name may not include ${include#*include }"
            wrong=1
        }
    done < <(grep -rE --include='*.h' --include='*.cpp' '^#include "bake/' "$folder")
done
# The node kit's own folders, from the lowest: each may include those before it, and what stands in osgTSS/src itself.
before=""
for name in draw joints extract update install; do
    before+=" $name"
    while IFS=: read -r file include; do
        target=${include#*\"osgTSS/src/}
        [[ "$target" != */* || "$before " == *" ${target%%/*} "* ]] || {
            echo "$file: osgTSS/src/$name may not include ${include#*include }"
            wrong=1
        }
    done < <(grep -rE '^#include "osgTSS/src/' "osgTSS/src/$name")
done
if [ "$(ls -d osgTSS/src/*/ | wc -l)" -ne "$(wc -w <<<"$before")" ]; then
    echo "osgTSS/src: expected its folders to be those that tests/layers.sh names:$before"
    wrong=1
fi
if grep -nE '^#include "osgTSS/src/[a-z]+/' osgTSS/src/*.h osgTSS/src/*.cpp; then wrong=1; fi
# Nothing in bake/ knows OpenSceneGraph or the node kit, and the kit does not know the report.
if grep -rnE '^#include [<"]osg' bake; then wrong=1; fi
if grep -rnE '^#include "bake/(compare|report|tool)/' osgTSS; then wrong=1; fi
exit "$wrong"
