#!/usr/bin/env bash
# judges.sh PROGRAMS FOLDER [COUNT]: COUNT random models in MJCF are read by MuJoCo and here, and COUNT random robots in
# URDF by urdfdom and here, and by MuJoCo, too, with those of compare_mujoco and compare_urdfdom that are in the folder
# PROGRAMS; the models go into FOLDER. All joints, shapes, poses and pairs are to be the same, but for what
# docs/ROBOTS.md says. A minute; a model is made again by its number: mjcf.py FOLDER N N.
# Exit 77, which CTest takes as skipped, where neither program was built.
set -euo pipefail
programs=$1 folder=$2 count=${3:-2000}
here=$(cd "$(dirname "$0")" && pwd)
wrong=0 judged=0
rm -rf "$folder"
judge() {
    local program=$1 maker=$2 pattern=$3 to=$folder/$1_$2
    shift 3
    if [ ! -x "$programs/$program" ]; then
        echo "$program was not built"
        return
    fi
    judged=1
    python3 "$here/$maker" "$to" 1 "$count" "$@"
    find "$to" -name "$pattern" -print0 | sort -z | xargs -0 -n 500 "$programs/$program" || wrong=1
}
judge compare_mujoco mjcf.py robot.xml
judge compare_mujoco urdf.py '*.urdf' right
judge compare_urdfdom urdf.py '*.urdf'
[ "$judged" -eq 1 ] || exit 77
exit "$wrong"
