#include "bake/base/Degrees.h"
#include "bake/geometry/PartSet.h"
#include "bake/scene/SceneReading.h"

namespace tss {

namespace {

SphereSet readSpheres(const SceneReading& reading, const PrimReader& table, const char* relationship) {
    SphereSet spheres;
    const std::string path = table.target(relationship);
    const int entry = path.empty() ? -1 : reading.resolve(table, relationship, path);
    if (path.empty()) table.problem(std::string("expected the relationship ") + relationship);
    if (entry < 0) return spheres;
    if (!reading.ownPrim(entry, "the spheres of a table")) return spheres;
    const PrimReader prim = reading.reader(entry);
    if (prim.prim().typeName != "Points") {
        reading.problems.add(table.placeOf(relationship, "targetPaths"),
                             "expected the path of Points, found \"" + path + "\"");
        return spheres;
    }
    const auto centres = prim.vectors(schema::points);
    const auto widths = prim.reals(schema::widths, centres.size(), Range{0});
    if (widths.size() != centres.size()) {
        if (!prim.has(schema::widths)) prim.problem("expected the attribute widths: the spheres' diameters");
        return spheres;
    }
    for (std::size_t i = 0; i < centres.size(); ++i) spheres.push_back({centres[i], widths[i] / 2});
    return spheres;
}

/// The sparse rows (CSR), with every index checked.
void readRows(const PrimReader& prim, Table& table) {
    const auto offsets = prim.indices(schema::rowOffsets);
    const auto columns = prim.indices(schema::columns);
    const auto number = [](std::size_t n) { return std::to_string(n); };
    if (offsets.size() != table.a.size() + 1)
        return prim.problem(schema::rowOffsets,
                            "expected " + number(table.a.size() + 1) +
                                " offsets, one a sphere of tss:spheres0 and the end, found " +
                                number(offsets.size()));
    if (offsets.front() != 0)
        return prim.problem(schema::rowOffsets, "expected 0 first, found " + number(offsets.front()));
    for (std::size_t i = 1; i < offsets.size(); ++i)
        if (offsets[i] < offsets[i - 1])
            return prim.problem(schema::rowOffsets, "expected offsets that never fall, found " +
                                                        number(offsets[i]) + " after " +
                                                        number(offsets[i - 1]) + " at index " + number(i));
    if (offsets.back() != columns.size())
        return prim.problem(schema::rowOffsets, "expected " + number(columns.size()) +
                                                    " last, the number of columns, found " +
                                                    number(offsets.back()));
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i] >= table.b.size())
            return prim.problem(schema::columns, "expected indices below " + number(table.b.size()) +
                                                     ", the number of tss:spheres1, found " +
                                                     number(columns[i]) + " at index " + number(i));
    table.rowOffsets = offsets;
    table.columns = columns;
}

std::pair<std::uint64_t, std::uint64_t> readTwo(const PrimReader& prim, const Attribute& attribute) {
    const auto two = prim.reals(attribute, 2, Range{0});
    return two.size() == 2 ? std::pair(std::uint64_t(two[0]), std::uint64_t(two[1]))
                           : std::pair<std::uint64_t, std::uint64_t>();
}

BakeRecord readRecord(const PrimReader& prim) {
    BakeRecord record;
    std::tie(record.spheresA, record.spheresB) = readTwo(prim, schema::generatedSpheres);
    record.candidatePairs = prim.count(schema::candidatePairs);
    record.lowerBound = prim.count(schema::lowerBound);
    for (const auto& [attribute, figure] : schema::fitFigures)
        if (const auto two = prim.reals(attribute, 2); two.size() == 2)
            record.fitA.*figure = two[0], record.fitB.*figure = two[1];
    return record;
}

std::vector<SurfacePart> readParts(const PrimReader& prim, const Attribute& triangles, const Attribute& cuts,
                                   const TriangleMesh& mesh) {
    const auto whole = prim.indices(triangles), which = prim.indices(cuts);
    const auto number = [](std::size_t n) { return std::to_string(n); };
    if (which.size() != whole.size()) {
        prim.problem(cuts, "expected " + number(whole.size()) + " numbers, one a part of " + triangles.name +
                               ", found " + number(which.size()));
        return {};
    }
    std::vector<SurfacePart> parts;
    PartSet before;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const SurfacePart part{whole[i], which[i]};
        if (part.triangle >= mesh.triangles.size())
            prim.problem(triangles, "expected indices below " + number(mesh.triangles.size()) +
                                        ", the number of the body's triangles, found " +
                                        number(part.triangle) + " at index " + number(i));
        else if (part.cuts < 1)
            prim.problem(cuts, "expected 1 or more, found 0 at index " + number(i));
        else if (i > 0 && !(parts.back() < part))
            prim.problem(triangles, "expected parts in rising order, found none at index " + number(i));
        else if (before.contains(part))
            prim.problem(cuts, "expected parts of which none is in another, found one at index " + number(i));
        else {
            parts.push_back(part);
            before.insert(part);
            continue;
        }
        return {};
    }
    return parts;
}

RestRegion readRegion(const SceneReading& reading, const PrimReader& prim, const Pair& pair) {
    const auto mesh = [&](int body) -> const TriangleMesh& {
        return reading.scene.bodies[static_cast<std::size_t>(body)].mesh;
    };
    RestRegion region;
    region.a = readParts(prim, schema::restTriangles0, schema::restCuts0, mesh(pair.bodyA));
    region.b = readParts(prim, schema::restTriangles1, schema::restCuts1, mesh(pair.bodyB));
    region.depth = prim.real(schema::restDepth, -1);
    return region;
}

Table readTable(const SceneReading& reading, const PrimReader& prim) {
    Table table;
    table.a = readSpheres(reading, prim, schema::spheres0);
    table.b = readSpheres(reading, prim, schema::spheres1);
    readRows(prim, table);
    table.restGaps = prim.reals(schema::restGaps, table.columns.size());
    table.epsilon = prim.real(schema::epsilon, 0, Range{0});
    table.gapDepth = prim.real(schema::gapDepth, 0, Range{0});
    table.gapMargin = prim.real(schema::gapMargin, 0, Range{0});
    table.boundMiss = prim.real(schema::boundMiss, -1);
    table.boundEarly = prim.real(schema::boundEarly, -1);
    table.certified = prim.flag(schema::certified, false);
    table.method = prim.text(schema::method, "");
    table.record = readRecord(prim);
    return table;
}

/// The pair's motion, with the limits that the table was made for.
void readMotion(const PrimReader& prim, Motion motion, Table& table) {
    const auto names = prim.texts(schema::dofs);
    const auto lower = prim.reals(schema::lower, motion.dofs.size());
    const auto upper = prim.reals(schema::upper, motion.dofs.size());
    std::vector<std::string> wanted;
    for (const Dof& dof : motion.dofs) wanted.push_back(dof.name);
    if (names != wanted) {
        std::string list;
        for (const std::string& name : wanted) list += (list.empty() ? "" : ", ") + name;
        return prim.problem(schema::dofs, "expected the DOFs of the pair's joints (" + list +
                                              "): the table is stale, bake it again");
    }
    if (lower.size() != names.size() || upper.size() != names.size()) {
        if (!names.empty() && (!prim.has(schema::lower) || !prim.has(schema::upper)))
            prim.problem("expected tss:lower and tss:upper: the limits that the table was made for");
        return;
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
        const bool turns = motion.dofs[k].kind == DofKind::Rotation;
        motion.dofs[k].lower = turns ? toRadians(lower[k]) : lower[k];
        motion.dofs[k].upper = turns ? toRadians(upper[k]) : upper[k];
        if (motion.dofs[k].lower > motion.dofs[k].upper)
            prim.problem(schema::upper, "expected upper limits that are not below the lower ones");
    }
    table.motion = std::move(motion);
}

NeverCollides readProof(const PrimReader& prim) {
    NeverCollides proof;
    proof.clearance = prim.real(schema::clearance, 0, Range{0});
    proof.cells = prim.count(schema::cells);
    proof.method = prim.text(schema::method, "");
    proof.record = readRecord(prim);
    return proof;
}

/// The prim that tss:table names, if it is of one of the two types; null with a problem if not.
const PrimReader* tablePrim(const SceneReading& reading, const PrimReader& owner, const std::string& path,
                            bool proofs, std::optional<PrimReader>& prim) {
    const int entry = path.empty() ? -1 : reading.resolve(owner, schema::table, path);
    if (entry < 0) return nullptr;
    prim.emplace(reading.reader(entry));
    const std::string& type = prim->prim().typeName;
    if (!reading.ownPrim(entry, "a table")) return nullptr;
    if (type == "TssTable" || (proofs && type == "TssNeverCollides")) return &*prim;
    reading.problems.add(owner.placeOf(schema::table, "targetPaths"),
                         std::string("expected the path of a TssTable") +
                             (proofs ? " or a TssNeverCollides" : "") + ", found \"" + path + "\"");
    return nullptr;
}

void readSkinTable(SceneReading& reading, const PrimReader& prim, SkinModel& skin) {
    auto table = std::make_shared<SkinTable>();
    table->table = readTable(reading, prim);
    table->skinVertices = prim.indices(schema::skinVertices);
    table->muscleOf = prim.indices(schema::muscleOf);
    table->travel = prim.real(schema::tableTravel, 0, Range{0});
    const std::size_t vertices = reading.scene.bodies[skin.body].mesh.vertices.size();
    const auto check = [&](const std::vector<std::uint32_t>& indices, std::size_t count, std::size_t below,
                           const Attribute& attribute) {
        if (indices.size() != count)
            return prim.problem(attribute, "expected " + std::to_string(count) +
                                               " indices, one a sphere, found " +
                                               std::to_string(indices.size()));
        for (std::uint32_t index : indices)
            if (index >= below)
                return prim.problem(attribute, "expected indices below " + std::to_string(below) +
                                                   ", found " + std::to_string(index));
    };
    check(table->skinVertices, table->table.a.size(), vertices, schema::skinVertices);
    check(table->muscleOf, table->table.b.size(), skin.muscles.size() + skin.bones.size(), schema::muscleOf);
    skin.table = std::move(table);
}

} // namespace

void readTables(SceneReading& reading) {
    std::optional<PrimReader> prim;
    for (Pair& pair : reading.scene.pairs) {
        const PrimReader owner = reading.reader(reading.index.find(pair.path));
        pair.tablePath = owner.target(schema::table);
        if (!tablePrim(reading, owner, pair.tablePath, true, prim)) continue;
        pair.sourceHash = prim->text(schema::sourceHash, "");
        if (prim->prim().typeName == "TssNeverCollides") {
            auto proof = std::make_shared<NeverCollides>(readProof(*prim));
            proof->restRegion = readRegion(reading, *prim, pair);
            pair.proof = std::move(proof);
            continue;
        }
        auto table = std::make_shared<Table>(readTable(reading, *prim));
        table->restRegion = readRegion(reading, *prim, pair);
        readMotion(*prim, pairMotion(reading.scene, pair), *table);
        pair.table = std::move(table);
    }
    for (SkinModel& skin : reading.scene.skins) {
        const PrimReader owner = reading.reader(reading.index.find(skin.path));
        skin.tablePath = owner.target(schema::table);
        if (!tablePrim(reading, owner, skin.tablePath, false, prim)) continue;
        skin.sourceHash = prim->text(schema::sourceHash, "");
        readSkinTable(reading, *prim, skin);
    }
}

} // namespace tss
