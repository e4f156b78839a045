#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/PrimIndex.h"
#include "bake/scene/Properties.h"
#include "bake/scene/Transforms.h"

namespace tss {

/// What the steps of readScene() share; each fills its part of the scene and looks at the parts before it.
struct SceneReading {
    SceneReading(const Layer& layer, Problems& problems)
        : layer(layer), index(layer, problems), problems(problems) {}

    const Layer& layer;
    PrimIndex index;
    Problems& problems;
    SceneModel scene;
    std::vector<SplitXform> bodyXforms;                   ///< one per body
    std::map<std::string, int> bodyAt, jointAt, muscleAt; ///< by prim path

    PrimReader reader(int entry) const {
        return {*index.entries[entry].prim, index.entries[entry].place, problems};
    }
    /// Calls visit(reader, entry) for each prim that is wanted(prim).
    template <class Wanted, class Visit>
    void forPrims(const Wanted& wanted, const Visit& visit) const {
        for (int entry = 0; entry < static_cast<int>(index.entries.size()); ++entry)
            if (wanted(*index.entries[entry].prim)) visit(reader(entry), entry);
    }

    /// The entry that a relationship's path names; a problem and -1 when there is no such prim.
    int resolve(const PrimReader& prim, const Attribute& relationship, const std::string& path) const;
    /// Tables are stored in the prims of the file itself, so that what has one or is one cannot come from
    /// references. False with a problem when it does.
    bool ownPrim(int entry, const char* what) const;
    /// The body that a relationship names; -1 when it names none, or with a problem when that is no body.
    int body(const PrimReader& prim, const Attribute& relationship, const std::string& path) const;
};

// Each part of a scene, its types, and how it goes from and into a layer.

/// The name that a prim had where it comes from; empty: its own.
std::string originalNameOf(const Prim& prim);
/// Keeps it in the metadata; `named` false: that it had none, and its own was made up.
void writeOriginalName(Prim& prim, const std::string& name, bool named = true);

void readBodies(SceneReading& reading);
void writeBodies(Layer& layer, const SceneModel& scene);
/// Transforms to the world, one per entry. unplaced: receives, one per entry, why it has none that can be
/// inverted, empty where it has; without it what is wrong with one is a problem.
std::vector<Xform> worldXforms(const SceneReading& reading, std::vector<std::string>* unplaced = nullptr);
/// The faces of a Mesh cut into triangles, its points stretched.
TriangleMesh readMesh(const PrimReader& prim, const SplitXform& xform);
std::vector<SchemaType> bodySchemas();

void readJoints(SceneReading& reading);
void writeJoints(Layer& layer, const SceneModel& scene);
/// The prim is a joint that a pair's motion can be made from.
bool isJoint(const Prim& prim);
/// The property has a value by time that need not be the one that is read where time does not count.
bool changes(const Property& property);
/// A property of a joint, its desired motion apart, that is not the same at all times; empty when there is
/// none.
std::string changingOf(const Prim& joint);
/// The DOFs, couplings and desired motion of a joint prim.
void readDofs(const PrimReader& prim, Joint& joint);
/// The same with limits; decides the type of its prim, jointType().
void writeDofs(PrimWriter& prim, const Joint& joint);
std::string jointType(const Joint& joint);
SchemaType dofSchema();
/// The couplings of a joint whose DOFs are known.
void readPlanes(const PrimReader& prim, Joint& joint);
void writePlanes(PrimWriter& prim, const Joint& joint);
std::vector<SchemaType> jointSchemas();

void readPairs(SceneReading& reading);
/// A mesh inside of a body that a joint moves would stay behind, and pairs of that body know nothing of it: a
/// problem of these, once skins and muscles are known, which follow by themselves.
void checkCarried(const SceneReading& reading);
/// Marks the pair's joint, or makes the prim that names its two bodies.
void writePair(Layer& layer, const SceneModel& scene, const Pair& pair);
/// The settings of a bake that a prim states; put in place of those that it had.
BakeSettings readSettings(const PrimReader& prim);
void writeSettings(Prim& prim, const BakeSettings& settings);
std::vector<SchemaType> pairSchemas();

void readMuscles(SceneReading& reading);
void writeMuscles(Layer& layer, const SceneModel& scene);
std::vector<SchemaType> muscleSchemas();

void readSkins(SceneReading& reading);
void writeSkins(Layer& layer, const SceneModel& scene);
std::vector<SchemaType> skinSchemas();

/// Tables and proofs of pairs and skins. Into a layer of the same scene, of which everything else stays as it
/// is: a pair or skin with neither table nor proof keeps what the layer has while it names a tablePath, and
/// loses it when it names none. Throws InputError when the layer has no prim for a pair or skin, and
/// std::logic_error for spheres that are not exact in float: what was proven of a table holds for the numbers
/// that are stored (see roundToFloat()).
void readTables(SceneReading& reading);
void storeTables(Layer& layer, const SceneModel& scene);
std::vector<SchemaType> tableSchemas();
/// The sphere set that a table names; as a guide that viewers do not render, where the table names it or
/// below the table.
SphereSet readSpheres(const SceneReading& reading, const PrimReader& table, const Attribute& relationship);
void writeSpheres(Layer& layer, const std::string& tablePath, const Attribute& relationship, const char* name,
                  const SphereSet& spheres);
SchemaType sphereSchema();
/// What went into a table or a proof.
const Fields<BakeRecord>& recordFields();
/// The exempt parts of a pair's surfaces, which its table or proof states: by body, triangles and cuts.
extern const Attribute restParts[2][2];
extern const Attribute restDepth;
RestRegion readRegion(const SceneReading& reading, const PrimReader& prim, const Pair& pair);
void writeRegion(PrimWriter& prim, const RestRegion& region);

template <class Items>
std::vector<std::string> pathsOf(const Items& items, const std::vector<int>& indices) {
    std::vector<std::string> paths;
    for (int index : indices) paths.push_back(items[index].path);
    return paths;
}

} // namespace tss
