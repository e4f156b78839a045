#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/PrimIndex.h"
#include "bake/scene/PrimReader.h"
#include "bake/scene/Xform.h"

namespace tss {

/// What the steps of readScene() share; each fills its part of the scene and looks at the parts before it.
struct SceneReading {
    SceneReading(const Layer& layer, Problems& problems)
        : layer(layer), index(layer, problems), problems(problems) {}

    const Layer& layer;
    PrimIndex index;
    Problems& problems;
    SceneModel scene;
    std::vector<SplitXform> bodyXforms;                   ///< one a body
    std::map<std::string, int> bodyAt, jointAt, muscleAt; ///< by prim path

    PrimReader reader(int entry) const {
        return {*index.entries[entry].prim, index.entries[entry].place, problems};
    }

    /// The entry that a relationship's path names; a problem and -1 when there is no such prim.
    int resolve(const PrimReader& prim, const char* relationship, const std::string& path) const {
        const int entry = index.find(path);
        if (entry < 0)
            problems.add(prim.placeOf(relationship, "targetPaths"),
                         "expected the path of a prim of the scene, found \"" + path + "\"");
        return entry;
    }

    /// Tables are stored in the prims of the file itself, so that what has one or is one cannot come from
    /// references. False with a problem when it does.
    bool ownPrim(int entry, const char* what) const {
        if (!index.entries[entry].composed) return true;
        problems.add(index.entries[entry].place,
                     std::string("expected ") + what + " on a prim without references");
        return false;
    }

    /// The body that a relationship names; -1 when it names none, or with a problem when that is no body.
    int body(const PrimReader& prim, const char* relationship, const std::string& path) const {
        if (path.empty() || resolve(prim, relationship, path) < 0) return -1;
        const auto found = bodyAt.find(path);
        if (found != bodyAt.end()) return found->second;
        problems.add(prim.placeOf(relationship, "targetPaths"),
                     "expected the path of a Mesh or an Xform, found \"" + path + "\"");
        return -1;
    }
};

void readBodies(SceneReading& reading);
/// Transforms to the world, one an entry.
std::vector<Xform> worldXforms(const SceneReading& reading);
/// The faces of a Mesh cut into triangles, its points stretched.
TriangleMesh readMesh(const PrimReader& prim, const SplitXform& xform);
void readJoints(SceneReading& reading);
void readPairs(SceneReading& reading);
void readMuscles(SceneReading& reading);
void readSkins(SceneReading& reading);
/// The weights that a skin of so many vertices brings along.
SkinWeights readSkinWeights(const SceneReading& reading, const PrimReader& prim, std::size_t vertices);
/// Tables and proofs of pairs and skins.
void readTables(SceneReading& reading);

/// The DOFs, couplings and desired motion of a joint prim.
void readDofs(const PrimReader& prim, Joint& joint);

/// The prim is a joint that a pair's motion can be made from.
bool isJoint(const Prim& prim);

/// The settings of a bake that a prim states.
BakeSettings readSettings(const PrimReader& prim);

} // namespace tss
