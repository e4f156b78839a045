#!/usr/bin/env bash
# One vocabulary: renames identifiers and files, nothing else. To be run in the root of a clean checkout of any later state:
#     bash rename.sh && cmake --preset release && cmake --build --preset release
# Names within string literals (messages, JSON keys, command-line words, file formats) stay as they are.
set -euo pipefail
[ -d bake ] && [ -d osgTSS ] || { echo "run it in the root of the repository" >&2; exit 2; }
git diff --quiet && git diff --cached --quiet || { echo "expected a clean work tree" >&2; exit 2; }

sources() { # sources PATHSPEC...: C++ sources below these paths
    git ls-files -- "$@" | grep -E '\.(h|cpp)$|^osgTSS/include/' || true
}
# ren 'perl substitutions' PATHSPEC...: outside of string literals and includes
ren() {
    local what=$1
    shift
    sources "$@" | TSS_WHAT="$what" xargs -r perl -i -pe '
        BEGIN { eval "sub change { local \$_ = shift; $ENV{TSS_WHAT}; return \$_ } 1" or die $@ }
        unless (/^#\s*include/) {
            s{("(?:[^"\\\n]|\\.)*")|([^"]+)}{defined $1 ? $1 : change($2)}ge;
        }'
}
# move OLD NEW: a file, its includes, and where documents name it
move() {
    [ -e "$1" ] || { echo "no $1: left out" >&2; return 0; }
    git mv "$1" "$2"
    local from=${1//./\\.}
    { git grep -lF "\"$1\"" -- bake osgTSS tests examples || true; } | xargs -r perl -pi -e "s{\"$from\"}{\"$2\"}g"
    local stem=${1%.*} target=${2%.*}
    { git grep -lF "$stem" -- 'docs/*.md' README.md 'bake/*CMakeLists.txt' 'tests/*.sh' || true; } |
        xargs -r perl -pi -e "s{\\b\Q$stem\E\\b}{$target}g"
}
all=(bake osgTSS tests examples)

# What a table must answer for, and who shows that it does not.
ren 's/\bObligation\b/ErrorContract/g' "${all[@]}"
ren 's/\blackingAtCentre\b/counterexampleAtCentre/g; s/\blackingElsewhere\b/counterexampleElsewhere/g;
     s/\blackingAt\b/counterexampleAt/g; s/\bLacking\b/Counterexample/g;
     s/(?<!found )(?<!is )\blacking\b/counterexample/g' bake/reduce tests/reduce
ren 's/\bDemandCover\b/ConstraintCover/g; s/\bcoverDemands\b/coverConstraints/g; s/\bdemandsAt\b/poseConstraintsAt/g;
     s/\bdemands_\b/constraints_/g; s/\bDemand\b/PoseConstraint/g; s/(?<!pose )(?<!all )\bdemands\b(?! at\b)/constraints/g;
     s/(?<=& )demand\b/constraint/g; s/\bdemand\./constraint./g' bake/reduce
ren 's/\bclimbDown\b/relaxEpsilon/g' bake/reduce

# Bounds of pairs over a cell.
ren 's/\bPairHere\b/PairInCell/g; s/\bPairAt\b/PairDistanceBounds/g' "${all[@]}"
ren 's/\bPairBits\b/ConcurrentPairs/g' "${all[@]}"
ren 's/\bb\.reach\b/b.motion/g; s/\bat\.reach\b/at.motion/g; s/CellMotion::Reach reach\{\};/CellMotion::PointMotion motion{};/g' bake/reduce
ren 's/const CellMotion::Reach& reach\b/const CellMotion::PointMotion\& pointMotion/g; s/\breach\.(move|remainder)\b/pointMotion.$1/g;
     s/\(cell, x, reach, centreA\)/(cell, x, pointMotion, centreA)/g' bake/search/PairAt.h bake/reduce/Domination.h
ren 's/\bCellMotion::Reach\b/CellMotion::PointMotion/g; s/\bCellMotion::reach\b/CellMotion::pointMotion/g' bake tests
ren 's/\bstruct Reach \{/struct PointMotion {/g; s/\bReach reach\(/PointMotion pointMotion(/g; s/\breach\(x\)/pointMotion(x)/g' bake/motion/MotionBound.h
ren 's/\b(motion|moves|bound|cell)\.reach\(/$1.pointMotion(/g' bake/fill bake/motion bake/reduce bake/search tests/search

# The distance of two centres at which contact begins.
ren 's/\bReachPair\b/ContactPair/g; s/\breachPair\b/contactPair/g' "${all[@]}"
ren 's/\b(p|pair|member|out|contactPair)\.reach\b(?!\()/$1.contactDistance/g' bake/reduce
ren 's/\bdouble reach = 0;/double contactDistance = 0;/g' bake/reduce/CoverProblem.h bake/respond/JointModel.h bake/table/Contact.h \
    bake/table/TablePairs.h bake/verify/MeshProof.h bake/verify/Models.h bake/verify/BoxProver.h
ren 's/\b(p|pair|test)\.reach\b(?!\()/$1.contactDistance/g; s/\]\.reach\b(?!\()/].contactDistance/g; s/\)\]\.reach\b(?!\()/)].contactDistance/g' \
    bake/table tests/table
ren 's/\bpair\.reach\b(?!\()/pair.contactDistance/g' bake/respond
ren 's/\bdouble reach;/double contactDistance;/g' bake/verify/BoxProver.h bake/verify/ExactPose.h
ren 's/\b(t|test|p|k|o|here)\.reach\b(?!\()/$1.contactDistance/g; s/\b(models|m_)\.reach\(/$1.contactDistance(/g;
     s/\bModels::reach\(/Models::contactDistance(/g' bake/verify tests/verify
ren 's/\bdouble reach\(SpherePair pair\)/double contactDistance(SpherePair pair)/g' bake/verify/Models.h
ren 's/\bdistance - reach\b/distance - contactDistance/g' bake/verify/BoxProver.h

# The table as a matrix times features.
ren 's/\bFoldErrors\b/FeatureFormErrors/g; s/\bmakeFold\b/makeFeatureForm/g; s/\bfoldMismatch\b/featureFormMismatch/g;
     s/\bFold\b/FeatureForm/g' bake tests/table tests/verify tests/bench tests/tool tests/report

# Questions to a prepared table, and the gap that a response keeps.
ren 's/\bunderNear\b/testsWithinNear/g; s/\ballUnder\b/allTestsWithin/g; s/\bunder(?=\(|<)/testsWithin/g; s/(?<=[.>*])under\b/testsWithin/g' \
    bake/table bake/respond tests/table
ren 's/\b(pair|added|group|back\(\)|\])\.off\b/$1.contactOffset/g; s/\.back\(\)\.off\b/.back().contactOffset/g; s/\]\.off\b/].contactOffset/g;
     s/\bdouble off\b/double contactOffset/g; s/\bleastOff\b/leastOffset/g; s/\bleastOffset \/ off\b/leastOffset \/ contactOffset/g;
     s/\(off \/ model/(contactOffset \/ model/g; s/^(\/\/\/ )off = 1\.5/$1contactOffset = 1.5/g' bake/respond/JointModel.h \
    bake/respond/JointModel.cpp bake/respond/JointAdvance.cpp bake/respond/JointSlide.cpp bake/respond/JointResponder.h \
    bake/respond/JointResponder.cpp

# Collision methods beside ours.
ren 's/\bRivalLoop\b/MethodLoop/g; s/\b(\w+)Rival\b/$1Method/g; s/\bRival\b/CollisionMethod/g;
     s/\bmakeContestants\b/makeMethodSet/g; s/\bContestants\b/MethodSet/g; s/\bcontestants\b/methodSet/g; s/\bcontestants_\b/methodSet_/g;
     s/\bEntrant\b/MethodsOfModel/g; s/\bentrants\b/others/g; s/\bentrant\b/entry/g' bake/compare bake/report tests/compare tests/report

# One name, one thing.
ren 's/\bCover\b/GrowingCover/g' bake/reduce tests/reduce
ren 's/\bProblem\b/ComparedPair/g' bake/compare bake/report tests/compare tests/report
ren 's/\bProblem\b/SearchInput/g' bake/search/CertifiedSearch.cpp
ren 's/\bProblem\b/ReachInput/g' bake/search/Reach.cpp
ren 's/\bProblem\b/CellInput/g' bake/search/UndecidedCells.cpp
ren 's/\bBallTree\b/MethodBallTree/g' bake/compare bake/report tests/compare tests/report
ren 's/\bAllPairs\b/AllSpherePairs/g' bake/compare
ren 's/\bCsv\b/CsvTable/g' bake/tool

move bake/search/PairAt.h bake/search/PairDistanceBounds.h
move bake/search/PairBits.h bake/search/ConcurrentPairs.h
move bake/search/PairBits.cpp bake/search/ConcurrentPairs.cpp
move bake/table/Fold.h bake/table/FeatureForm.h
move bake/table/Fold.cpp bake/table/FeatureForm.cpp
move bake/verify/FoldErrors.cpp bake/verify/FeatureFormErrors.cpp
move bake/spheres/Cover.h bake/spheres/PatchCover.h
move bake/spheres/Cover.cpp bake/spheres/PatchCover.cpp
move bake/compare/Rival.h bake/compare/CollisionMethod.h
move bake/compare/Rival.cpp bake/compare/CollisionMethod.cpp
move bake/compare/TableRivals.cpp bake/compare/TableMethods.cpp
move bake/compare/Problem.h bake/compare/ComparedPair.h
move bake/compare/BallTree.h bake/compare/MethodBallTree.h
move bake/compare/BallTree.cpp bake/compare/MethodBallTree.cpp
move bake/compare/AllPairs.cpp bake/compare/AllSpherePairs.cpp
move bake/compare/AllPairsSimd.cpp bake/compare/AllSpherePairsSimd.cpp
move bake/compare/SphereTree.cpp bake/compare/SphereTreeMethod.cpp
move bake/report/Contestants.h bake/report/MethodSet.h
move bake/report/Contestants.cpp bake/report/MethodSet.cpp
move bake/tool/Csv.h bake/tool/CsvTable.h
move bake/tool/Csv.cpp bake/tool/CsvTable.cpp

# Documents that name identifiers.
perl -pi -e 's/`RivalLoop</`MethodLoop</g; s/`Fold`/`FeatureForm`/g; s/`Contestants`/`MethodSet`/g; s/, `Cover` \|/, `PatchCover` |/g' docs/METHOD.md docs/EXTENDING.md
# Self-including sources (Highway), and order of includes.
perl -pi -e 's{bake/compare/AllPairsSimd\.cpp}{bake/compare/AllSpherePairsSimd.cpp}g' bake/compare/AllSpherePairsSimd.cpp 2>/dev/null || true
git diff --name-only HEAD | grep -E '\.(h|cpp)$' | while read -r file; do [ -e "$file" ] && clang-format -i "$file"; done
git add -A
echo "renamed: $(git diff --cached --stat HEAD | tail -1)"
