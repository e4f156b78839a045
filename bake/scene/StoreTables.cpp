#include "bake/scene/StoreTables.h"

#include "bake/base/Degrees.h"
#include "bake/base/Error.h"
#include "bake/scene/SceneWriting.h"

#include <algorithm>

namespace tss {

namespace {

Prim& ownerPrim(Layer& layer, const std::string& path) {
    Prim* prim = findPrim(layer, path);
    if (!prim) throw InputError({"", "", path}, "expected this prim in the layer that tables are stored in");
    return *prim;
}

/// Where the table of an owner goes: where it was, or a free name below the owner.
std::string placeFor(const Prim& owner, const std::string& ownerPath, const std::string& wanted) {
    if (!wanted.empty()) return wanted;
    std::string name = "Table";
    for (int k = 2; owner.child(name); ++k) name = "Table" + std::to_string(k);
    return ownerPath + "/" + name;
}

/// Takes an old table and its spheres out of the layer.
void removeTable(Layer& layer, Prim& owner) {
    const Property* property = owner.property(schema::table);
    if (!property || !property->isRelationship()) return;
    const auto paths = listItems(*property->targetPaths);
    owner.properties.erase(schema::table);
    for (const std::string& path : paths) removePrim(layer, path);
}

/// The prim at this path, in its old place among its siblings; emptied when it was of another type.
PrimWriter tablePrim(Layer& layer, const std::string& path, const std::string& type) {
    Prim& prim = makePrim(layer, path, type);
    if (prim.typeName != type) {
        Prim empty;
        empty.typeName = type;
        empty.name = prim.name;
        prim = std::move(empty);
    }
    for (const Attribute& optional :
         {schema::restGaps, schema::restTriangles0, schema::restCuts0, schema::restTriangles1,
          schema::restCuts1, schema::restDepth, schema::dofs, schema::lower, schema::upper,
          schema::generatedSpheres, schema::candidatePairs, schema::lowerBound, schema::cells})
        prim.properties.erase(optional.name);
    for (const auto& [attribute, figure] : schema::fitFigures) prim.properties.erase(attribute.name);
    return PrimWriter(prim);
}

/// The path of a sphere set, as the table names it already or below the table.
std::string spheresPath(PrimWriter& table, const char* relationship, const std::string& fallback) {
    const Property* old = table.prim().property(relationship);
    const auto paths =
        old && old->isRelationship() ? listItems(*old->targetPaths) : std::vector<std::string>();
    if (paths.size() == 1) return paths.front();
    table.setTargets(relationship, {fallback});
    return fallback;
}

void writeLimits(PrimWriter& prim, const Motion& motion) {
    if (motion.dofs.empty()) return;
    std::vector<std::string> names;
    std::vector<double> lower, upper;
    for (const Dof& dof : motion.dofs) {
        const bool turns = dof.kind == DofKind::Rotation;
        names.push_back(dof.name);
        lower.push_back(turns ? degreesInside(dof.lower, dof.upper) : dof.lower);
        upper.push_back(turns ? degreesInside(dof.upper, dof.lower) : dof.upper);
    }
    prim.set(schema::dofs, names);
    prim.set(schema::lower, lower);
    prim.set(schema::upper, upper);
}

void writeRecord(PrimWriter& prim, const BakeRecord& record) {
    const auto count = [](std::uint64_t n) { return Value(n); };
    if (record.spheresA || record.spheresB)
        prim.set(schema::generatedSpheres,
                 std::vector<double>{double(record.spheresA), double(record.spheresB)});
    if (record.candidatePairs) prim.set(schema::candidatePairs, count(record.candidatePairs));
    if (record.lowerBound) prim.set(schema::lowerBound, count(record.lowerBound));
    for (const auto& [attribute, figure] : schema::fitFigures)
        if (record.fitA.*figure >= 0 || record.fitB.*figure >= 0)
            prim.set(attribute, std::vector<double>{record.fitA.*figure, record.fitB.*figure});
}

void writeRegion(PrimWriter& prim, const RestRegion& region) {
    if (region.empty()) return;
    const auto write = [&](const std::vector<SurfacePart>& parts, const Attribute& triangles,
                           const Attribute& cuts) {
        std::vector<std::uint32_t> whole, which;
        for (const SurfacePart& part : parts) {
            whole.push_back(part.triangle);
            which.push_back(part.cuts);
        }
        prim.set(triangles, whole);
        prim.set(cuts, which);
    };
    write(region.a, schema::restTriangles0, schema::restCuts0);
    write(region.b, schema::restTriangles1, schema::restCuts1);
    prim.setUnless(schema::restDepth, region.depth, -1.0);
}

void writeTable(Layer& layer, const std::string& path, const Table& table, const std::string& hash) {
    PrimWriter prim = tablePrim(layer, path, "TssTable");
    const std::string spheres0 = spheresPath(prim, schema::spheres0, path + "/Spheres0");
    const std::string spheres1 = spheresPath(prim, schema::spheres1, path + "/Spheres1");
    prim.set(schema::rowOffsets, table.rowOffsets);
    prim.set(schema::columns, table.columns);
    if (!table.restGaps.empty()) prim.set(schema::restGaps, table.restGaps);
    writeRegion(prim, table.restRegion);
    writeLimits(prim, table.motion);
    prim.setUnless(schema::epsilon, table.epsilon, 0.0);
    prim.setUnless(schema::gapDepth, table.gapDepth, 0.0);
    prim.setUnless(schema::gapMargin, table.gapMargin, 0.0);
    prim.setUnless(schema::boundMiss, table.boundMiss, -1.0);
    prim.setUnless(schema::boundEarly, table.boundEarly, -1.0);
    prim.setUnless(schema::certified, Value(table.certified), Value(false));
    prim.setUnless(schema::method, table.method, "");
    prim.setUnless(schema::sourceHash, hash, "");
    writeRecord(prim, table.record);
    writeSpheres(layer, spheres0, table.a);
    writeSpheres(layer, spheres1, table.b);
}

void writeProof(Layer& layer, const std::string& path, const NeverCollides& proof, const std::string& hash) {
    PrimWriter prim = tablePrim(layer, path, "TssNeverCollides");
    prim.setUnless(schema::clearance, proof.clearance, 0.0);
    writeRegion(prim, proof.restRegion);
    if (proof.cells) prim.set(schema::cells, Value(proof.cells));
    prim.setUnless(schema::method, proof.method, "");
    prim.setUnless(schema::sourceHash, hash, "");
    writeRecord(prim, proof.record);
}

void storePair(Layer& layer, const Pair& pair) {
    Prim& owner = ownerPrim(layer, pair.path);
    writeSettings(owner, pair.settings);
    if (!pair.table && !pair.proof) {
        if (pair.tablePath.empty()) removeTable(layer, owner);
        return;
    }
    const std::string path = placeFor(owner, pair.path, pair.tablePath);
    PrimWriter(owner).setTargets(schema::table, {path});
    if (pair.table)
        writeTable(layer, path, *pair.table, pair.sourceHash);
    else
        writeProof(layer, path, *pair.proof, pair.sourceHash);
}

void storeSkin(Layer& layer, const SkinModel& skin) {
    Prim& owner = ownerPrim(layer, skin.path);
    writeSettings(owner, skin.settings);
    if (!skin.table) {
        if (skin.tablePath.empty()) removeTable(layer, owner);
        return;
    }
    const std::string path = placeFor(owner, skin.path, skin.tablePath);
    PrimWriter(owner).setTargets(schema::table, {path});
    writeTable(layer, path, skin.table->table, skin.sourceHash);
    PrimWriter prim(*findPrim(layer, path));
    prim.set(schema::skinVertices, skin.table->skinVertices);
    prim.set(schema::muscleOf, skin.table->muscleOf);
    prim.setUnless(schema::tableTravel, skin.table->travel, 0.0);
}

} // namespace

void writeSettings(Prim& prim, const BakeSettings& settings) {
    std::erase_if(prim.properties,
                  [](const auto& property) { return property.first.starts_with(schema::bakePrefix); });
    for (const auto& [key, text] : settings) {
        std::string name = schema::bakePrefix + key;
        std::replace(name.begin(), name.end(), '-', '_');
        PrimWriter(prim).set(Attribute{name.c_str(), "string", true}, Value(text));
    }
}

void storeTables(Layer& layer, const SceneModel& scene) {
    for (const Pair& pair : scene.pairs) storePair(layer, pair);
    for (const SkinModel& skin : scene.skins) storeSkin(layer, skin);
}

} // namespace tss
