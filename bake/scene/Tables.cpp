#include "bake/base/Error.h"
#include "bake/motion/DofUnits.h"
#include "bake/scene/SceneParts.h"

#include <fmt/format.h>

namespace tss {

namespace {

constexpr Attribute spheres0 = declared(
    "rel tss:spheres0", "the used spheres of body 0, `Points` with `purpose = guide`; `widths` are "
                        "diameters. Numbers are floats, and what is proven is proven for these floats");
constexpr Attribute spheres1 = declared("rel tss:spheres1", "the same of body 1");
constexpr Attribute rowOffsets = declared(
    "uniform int[] tss:rowOffsets",
    "sparse rows: sphere i of body 0 is tested against the spheres `columns[rowOffsets[i]]` ... of body 1");
constexpr Attribute columns = declared("uniform int[] tss:columns", "see `tss:rowOffsets`");
constexpr Attribute dofs = declared("uniform token[] tss:dofs", "the DOFs that the table is good for");
constexpr Attribute lower = declared("uniform double[] tss:lower", "their lower limits");
constexpr Attribute upper = declared("uniform double[] tss:upper", "their upper limits");
constexpr Attribute sourceHash =
    declared("uniform string tss:sourceHash",
             "SHA-256 of what it was made from, in five parts: the two meshes, frames, limits, settings");
constexpr Attribute skinVertices =
    declared("uniform int[] tss:skinVertices", "of a skin's table: the vertex of each skin sphere");
constexpr Attribute muscleOf =
    declared("uniform int[] tss:muscleOf", "of a skin's table: the place of each muscle sphere's muscle in "
                                           "`tss:muscles`, then that of its bone in `tss:bones`");

const Fields<Table>& tableFields() {
    static const Fields<Table> fields{
        spheres0,
        spheres1,
        rowOffsets,
        columns,
        {declared("uniform double[] tss:restGaps",
                  "gap of each test below which it counts as contact; absent: all 0"),
         [](const PrimReader& prim, const Attribute& attribute, Table& table) {
             table.restGaps = prim.reals(attribute, table.columns.size());
         },
         [](PrimWriter& prim, const Attribute& attribute, const Table& table) {
             prim.setIfAny(attribute, table.restGaps);
         }},
        restParts[0][0],
        restParts[0][1],
        restParts[1][0],
        restParts[1][1],
        restDepth,
        dofs,
        lower,
        upper,
        field("uniform double tss:epsilon", &Table::epsilon, 0, atLeast(0),
              "its gap is at most the spheres' and this, at every pose"),
        field("uniform double tss:gapDepth", &Table::gapDepth, 0, atLeast(0),
              "its gap is right down to this depth"),
        field("uniform double tss:gapMargin", &Table::gapMargin, 0, atLeast(0), "and up to this distance"),
        field("uniform double tss:boundMiss", &Table::boundMiss, std::nullopt, anyNumber,
              "0: no contact is missed; else where the surfaces touch the table's gap is at most this, and "
              "contact may be missed; absent, or negative: not known"),
        field("uniform double tss:boundEarly", &Table::boundEarly, std::nullopt, anyNumber,
              "contact is reported only when this near; absent, or negative: not known"),
        field("uniform bool tss:certified", &Table::certified, false, anyNumber,
              "the bounds hold for every pose, not for samples (false)"),
        field("uniform token tss:method", &Table::method, "", anyNumber, "how it was made"),
        sourceHash};
    return fields;
}

const Fields<SkinTable>& skinTableFields() {
    static const Fields<SkinTable> fields{skinVertices, muscleOf,
                                          field("uniform double tss:travel", &SkinTable::travel, 0,
                                                atLeast(0), "of a skin's table: that of its skin")};
    return fields;
}

const Fields<NeverCollides>& proofFields() {
    static const Fields<NeverCollides> fields{
        field("uniform double tss:clearance", &NeverCollides::clearance, 0, atLeast(0),
              "the surfaces stay farther apart than this, at every pose"),
        field("uniform uint64 tss:cells", &NeverCollides::cells, 0, anyNumber,
              "cells of the limits that the proof took"),
        field("uniform token tss:method", &NeverCollides::method, "", anyNumber, "how it was made"),
        sourceHash};
    return fields;
}

/// The sparse rows (CSR), with every index checked.
void readRows(const PrimReader& prim, Table& table) {
    const auto offsets = prim.indices(rowOffsets), across = prim.indices(columns);
    if (offsets.size() != table.a.size() + 1)
        return prim.problem(rowOffsets, "expected ", table.a.size() + 1,
                            " offsets, one a sphere of tss:spheres0 and the end, found ", offsets.size());
    if (offsets.front() != 0) return prim.problem(rowOffsets, "expected 0 first, found ", offsets.front());
    for (std::size_t i = 1; i < offsets.size(); ++i)
        if (offsets[i] < offsets[i - 1])
            return prim.problem(rowOffsets, "expected offsets that never fall, found ", offsets[i], " after ",
                                offsets[i - 1], " at index ", i);
    if (offsets.back() != across.size())
        return prim.problem(rowOffsets, "expected ", across.size(), " last, the number of columns, found ",
                            offsets.back());
    for (std::size_t i = 0; i < across.size(); ++i)
        if (across[i] >= table.b.size())
            return prim.problem(columns, "expected indices below ", table.b.size(),
                                ", the number of tss:spheres1, found ", across[i], " at index ", i);
    table.rowOffsets = offsets;
    table.columns = across;
}

/// The pair's motion, with the limits that the table was made for.
void readMotion(const PrimReader& prim, Motion motion, Table& table) {
    const auto names = prim.texts(dofs);
    const auto low = prim.reals(lower, motion.dofs.size()), high = prim.reals(upper, motion.dofs.size());
    std::vector<std::string> wanted;
    for (const Dof& dof : motion.dofs) wanted.push_back(dof.name);
    if (names != wanted)
        return prim.problem(dofs, "expected the DOFs of the pair's joints (",
                            fmt::format("{}", fmt::join(wanted, ", ")),
                            "): the table is stale, bake it again");
    if (low.size() != names.size() || high.size() != names.size()) {
        if (!names.empty() && (!prim.has(lower) || !prim.has(upper)))
            prim.problem("expected tss:lower and tss:upper: the limits that the table was made for");
        return;
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
        Dof& dof = motion.dofs[k];
        dof.lower = fromUser(dof, low[k]);
        dof.upper = fromUser(dof, high[k]);
        if (dof.lower > dof.upper)
            prim.problem(upper, "expected upper limits that are not below the lower ones");
    }
    table.motion = std::move(motion);
}

void writeMotion(PrimWriter& prim, const Motion& motion) {
    std::vector<std::string> names;
    std::vector<double> low, high;
    for (const Dof& dof : motion.dofs) {
        const bool turns = dof.kind == DofKind::Rotation;
        names.push_back(dof.name);
        low.push_back(turns ? degreesInside(dof.lower, dof.upper) : dof.lower);
        high.push_back(turns ? degreesInside(dof.upper, dof.lower) : dof.upper);
    }
    prim.setIfAny(dofs, names);
    prim.setIfAny(lower, low);
    prim.setIfAny(upper, high);
}

Table readTable(const SceneReading& reading, const PrimReader& prim) {
    Table table;
    table.a = readSpheres(reading, prim, spheres0);
    table.b = readSpheres(reading, prim, spheres1);
    readRows(prim, table);
    tableFields().read(prim, table);
    recordFields().read(prim, table.record);
    return table;
}

/// The prim that tss:table of a pair or a skin names, if it is of one of the two types; nothing, with a
/// problem, if not.
template <class Owner>
std::optional<PrimReader> tableOf(const SceneReading& reading, Owner& of, bool proofs) {
    const PrimReader owner = reading.reader(reading.index.find(of.path));
    const std::string& path = of.tablePath = owner.target(schema::table);
    const int entry = path.empty() ? -1 : reading.resolve(owner, schema::table, path);
    if (entry < 0 || !reading.ownPrim(entry, "a table")) return std::nullopt;
    const PrimReader prim = reading.reader(entry);
    const std::string& type = prim.prim().typeName;
    if (type == "TssTable" || (proofs && type == "TssNeverCollides")) {
        of.sourceHash = prim.text(sourceHash);
        return prim;
    }
    owner.targetProblem(schema::table, "expected the path of a TssTable",
                        proofs ? " or a TssNeverCollides" : "", ", found \"", path, "\"");
    return std::nullopt;
}

void readPairTable(const SceneReading& reading, Pair& pair) {
    const auto prim = tableOf(reading, pair, true);
    if (!prim) return;
    if (prim->prim().typeName == "TssNeverCollides") {
        NeverCollides proof;
        proofFields().read(*prim, proof);
        recordFields().read(*prim, proof.record);
        proof.restRegion = readRegion(reading, *prim, pair);
        pair.proof = std::make_shared<NeverCollides>(std::move(proof));
    } else {
        Table table = readTable(reading, *prim);
        table.restRegion = readRegion(reading, *prim, pair);
        readMotion(*prim, pairMotion(reading.scene, pair), table);
        pair.table = std::make_shared<Table>(std::move(table));
    }
}

void readSkinTable(const SceneReading& reading, SkinModel& skin) {
    const auto prim = tableOf(reading, skin, false);
    if (!prim) return;
    SkinTable table;
    table.table = readTable(reading, *prim);
    table.skinVertices = prim->indices(skinVertices);
    table.muscleOf = prim->indices(muscleOf);
    skinTableFields().read(*prim, table);
    const auto check = [&](const std::vector<std::uint32_t>& indices, std::size_t count, std::size_t below,
                           const Attribute& attribute) {
        if (indices.size() != count)
            return prim->problem(attribute, "expected ", count, " indices, one a sphere, found ",
                                 indices.size());
        for (std::uint32_t index : indices)
            if (index >= below)
                return prim->problem(attribute, "expected indices below ", below, ", found ", index);
    };
    check(table.skinVertices, table.table.a.size(), reading.scene.bodies[skin.body].mesh.vertices.size(),
          skinVertices);
    check(table.muscleOf, table.table.b.size(), skin.muscles.size() + skin.bones.size(), muscleOf);
    skin.table = std::make_shared<SkinTable>(std::move(table));
}

/// The prim for a table of this type: where it was, or under a free name below the owner; emptied when it was
/// of another type. The owner names it.
Prim& tablePrim(Layer& layer, Prim& owner, const std::string& ownerPath, std::string& path,
                const std::string& type) {
    if (path.empty()) {
        std::string name = "Table";
        for (int k = 2; owner.child(name); ++k) name = "Table" + std::to_string(k);
        path = ownerPath + "/" + name;
    }
    PrimWriter(owner).setTargets(schema::table, {path});
    Prim& prim = makePrim(layer, path, type);
    if (prim.typeName != type) {
        Prim empty;
        empty.typeName = type;
        empty.name = prim.name;
        prim = std::move(empty);
    }
    return prim;
}

void writeTable(Layer& layer, PrimWriter& prim, const std::string& path, const Table& table) {
    prim.set(rowOffsets, table.rowOffsets);
    prim.set(columns, table.columns);
    tableFields().write(prim, table);
    recordFields().write(prim, table.record);
    writeRegion(prim, table.restRegion);
    writeMotion(prim, table.motion);
    writeSpheres(layer, path, spheres0, "Spheres0", table.a);
    writeSpheres(layer, path, spheres1, "Spheres1", table.b);
}

/// Stores what was baked for a pair or a skin: `write` fills the prim, unless there is nothing.
template <class Owned, class Write>
void store(Layer& layer, const Owned& owned, bool any, const char* type, const Write& write) {
    Prim* owner = findPrim(layer, owned.path);
    if (!owner)
        throw InputError({"", "", owned.path},
                         "expected this prim in the layer that the scene was read from; without that layer "
                         "(SceneModel::layer null) the whole scene is written");
    writeSettings(*owner, owned.settings);
    std::string path = owned.tablePath;
    if (any) {
        PrimWriter prim(tablePrim(layer, *owner, owned.path, path, type));
        prim.setUnless(sourceHash, owned.sourceHash, "");
        write(prim, path);
        return;
    }
    const Property* old = owner->property(schema::table.name);
    if (!path.empty() || !old || !old->isRelationship()) return;
    const auto paths = listItems(*old->targetPaths);
    PrimWriter(*owner).remove(schema::table);
    for (const std::string& gone : paths) removePrim(layer, gone); // with its spheres
}

} // namespace

std::vector<SchemaType> tableSchemas() {
    return {tableFields().schema("TssTable"), skinTableFields().schema("TssTable"),
            recordFields().schema("TssTable"), proofFields().schema("TssNeverCollides"), sphereSchema()};
}

void readTables(SceneReading& reading) {
    for (Pair& pair : reading.scene.pairs) readPairTable(reading, pair);
    for (SkinModel& skin : reading.scene.skins) readSkinTable(reading, skin);
}

void storeTables(Layer& layer, const SceneModel& scene) {
    for (const Pair& pair : scene.pairs) {
        const char* type = pair.table ? "TssTable" : "TssNeverCollides";
        store(layer, pair, pair.table || pair.proof, type, [&](PrimWriter& prim, const std::string& path) {
            if (pair.table) return writeTable(layer, prim, path, *pair.table);
            proofFields().write(prim, *pair.proof);
            recordFields().write(prim, pair.proof->record);
            writeRegion(prim, pair.proof->restRegion);
        });
    }
    for (const SkinModel& skin : scene.skins)
        store(layer, skin, skin.table != nullptr, "TssTable", [&](PrimWriter& prim, const std::string& path) {
            prim.set(skinVertices, skin.table->skinVertices);
            prim.set(muscleOf, skin.table->muscleOf);
            skinTableFields().write(prim, *skin.table);
            writeTable(layer, prim, path, skin.table->table);
        });
}

} // namespace tss
