#include "bake/respond/SkinRows.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/respond/SkinClearance.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinContactSearch.h"

#include <algorithm>
#include <set>

namespace tss {
namespace {

using Vec3f = Eigen::Vector3f;

Vec3 triangleNormal(const TriangleMesh& mesh, int t) {
    return mesh.areaNormal(static_cast<std::size_t>(t)).normalized();
}

void addRowsOf(SkinRig& rig, const SkinContacts& found, SkinContactKind kind, std::vector<bool>& pushed) {
    std::size_t body = 0;
    for (std::uint32_t v = 0; v < found.triangles.size(); ++v) {
        const std::vector<int>& triangles = found.triangles[v];
        if (kind == SkinContactKind::BodyOnSkin)
            while (v >= rig.bodies[body].first + rig.bodies[body].count) ++body;
        if (triangles.empty()) continue;
        SkinRow row;
        row.kind = kind;
        row.vertex = v;
        row.body = static_cast<std::uint32_t>(body);
        row.first = static_cast<std::uint32_t>(rig.starts.size());
        rig.starts.insert(rig.starts.end(), triangles.begin(), triangles.end());
        row.last = static_cast<std::uint32_t>(rig.starts.size());
        row.insideAtRest = found.outside[v] != 0;
        rig.rows.push_back(row);
        for (const int t : triangles)
            for (const int corner : rig.triangles[t]) pushed[corner] = true;
        if (kind == SkinContactKind::SkinOnSkin) pushed[v] = true;
    }
}

bool ofMuscle(const SkinRig& rig, const SkinRow& row) {
    return row.kind != SkinContactKind::SkinOnSkin && !rig.bodies[row.body].bone();
}

/// Sets the clearances of a row at rest or at one node of its muscle, which the scene is at.
void measureClearance(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, SkinClearance* starts) {
    measureOffsets(rig, scene, row, starts);
    const SkinPlane plane = queryContact(rig, scene, row);
    float& gap = starts->gap();
    gap = starts->offsetAndGap.head<3>().norm();
    if (plane.found)
        gap = std::clamp(plane.distance, 0.0f, gap);
    else if (row.kind != SkinContactKind::SkinOnBody) // the surface faces another way
        gap = heightOverStarts(rig, scene, row);
}

/// Lowers the gap of each node to one that holds for all activations up to the next node.
void boundBetweenNodes(SkinClearance* at, std::size_t nodes, std::size_t starts) {
    for (std::size_t n = 0; n + 1 < nodes; ++n, at += starts) {
        float step = 0;
        for (std::size_t k = 0; k < starts; ++k)
            step = std::max(step, (at[starts + k].offsetAndGap - at[k].offsetAndGap).head<3>().norm());
        at->gap() = std::max(std::min(at->gap(), at[starts].gap()) - step / 2, 0.0f);
    }
}

/// Measures a row at rest: overlap, the surface's normal at the anchor, and, unless it is a muscle's, its
/// clearance.
void measureAtRest(SkinRig& rig, const SkinScene& scene, SkinRow& row) {
    const bool body = row.kind == SkinContactKind::SkinOnBody, bone = rig.bodies[row.body].bone();
    if (body) {
        const SkinBody& at = rig.bodies[row.body];
        for (int k = 0; k < 3; ++k)
            row.facing +=
                row.weights[k] * scene.normals[at.first + at.triangles[rig.starts[row.first]][k]].head<3>();
        if (row.facing.squaredNorm() > 0) row.facing.normalize();
    }
    SkinClearance& clearance = rig.clearances[clearancesAtRest(rig, row)];
    measureOffsets(rig, scene, row, &clearance);
    row.offset = -1; // so that the query trusts an overlap of any depth
    SkinPlane plane = queryContact(rig, scene, row, 0);
    row.offset = 0;
    if (body && row.insideAtRest && plane.found && plane.distance > 0) {
        row.flipped = true;
        plane = queryContact(rig, scene, row, 0);
    }
    if (body && bone) {
        // No contact before the vertex has moved by its distance from the bone.
        const Vec3 x = scene.skin[row.vertex].head<3>().cast<double>();
        clearance.gap() =
            row.insideAtRest
                ? 0
                : static_cast<float>(rig.bodies[row.body].locator->nearest(x, infinity).distance);
        if (row.insideAtRest && plane.found) row.offset = std::min(plane.distance, 0.0f);
    } else {
        if (plane.found) row.offset = std::min(plane.distance, 0.0f);
        measureClearance(rig, scene, row, &clearance);
    }
}

/// Whether the nearest point of a bone lies before the outer side of a skin vertex, and faces it.
bool facesFromOutside(const TriangleMesh& bone, const NearestPoint& near, const Vec3& x, const Vec3& own) {
    const Vec3 normal = triangleNormal(bone, near.triangle), away = x - near.point;
    return normal.dot(own) < 0 && own.dot(away) * normal.dot(away) < 0;
}

} // namespace

void addBodyRows(SkinRig& rig, const SkinAnatomy& anatomy, const SkinTable& table) {
    const Table& t = table.table;
    std::vector<SkinRow> rows;
    std::set<std::pair<std::uint32_t, std::uint32_t>> known; // vertex, body
    for (std::size_t i = 0; i < t.a.size(); ++i)
        for (std::uint32_t k = t.rowOffsets[i]; k < t.rowOffsets[i + 1]; ++k)
            known.emplace(anatomy.first[table.skinVertices[i]], table.muscleOf[t.columns[k]]);
    for (const auto& [vertex, body] : known) {
        rows.emplace_back().vertex = vertex;
        rows.back().body = body;
    }
    std::vector<int> start(rows.size(), -1);
    parallelFor(rows.size(), [&](std::size_t k) {
        SkinRow& row = rows[k];
        const Vec3 &x = anatomy.skin.vertices[row.vertex], &own = anatomy.normals[row.vertex];
        const MuscleDeformer& body = *anatomy.bodies[row.body];
        const TriangleMesh& surface = body.muscle().surface;
        const NearestPoint near = anatomy.locators[row.body].nearest(x, anatomy.size);
        if (near.triangle < 0) return;
        row.insideAtRest = anatomy.inside[row.body][row.vertex];
        row.fromOutside = body.rigid() && facesFromOutside(surface, near, x, own);
        row.weights = near.weights.cast<float>();
        Vec3 smooth = Vec3::Zero();
        for (int c = 0; c < 3; ++c)
            smooth += near.weights[c] * anatomy.surfaceNormals[row.body][surface.triangles[near.triangle][c]];
        // Skin beyond a muscle's far side does not lie on the muscle.
        if (body.rigid() || row.insideAtRest || smooth.dot(own) > 0) start[k] = near.triangle;
    });
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (start[k] < 0) continue;
        rows[k].first = static_cast<std::uint32_t>(rig.starts.size());
        rows[k].last = rows[k].first + 1;
        rig.starts.push_back(start[k]);
        rig.rows.push_back(rows[k]);
    }
}

std::vector<bool> addRows(SkinRig& rig, const std::vector<std::uint32_t>& indexOf) {
    std::vector<bool> pushed(rig.places.size(), false);
    for (SkinRow& row : rig.rows) {
        row.vertex = indexOf[row.vertex];
        pushed[row.vertex] = true;
    }
    std::ranges::sort(rig.rows, {}, [](const SkinRow& row) { return std::pair(row.vertex, row.body); });
    const SkinContactSearch found = searchContacts(rig);
    addRowsOf(rig, found.bodies, SkinContactKind::BodyOnSkin, pushed);
    addRowsOf(rig, found.folds, SkinContactKind::SkinOnSkin, pushed);
    return pushed;
}

void measureRows(SkinRig& rig) {
    for (SkinRow& row : rig.rows) {
        row.clearance = static_cast<std::uint32_t>(rig.clearances.size());
        const std::size_t nodes = ofMuscle(rig, row) ? rig.bodies[row.body].nodes.size() : 1;
        rig.clearances.resize(rig.clearances.size() + nodes * (row.last - row.first));
    }
    SkinScene scene;
    std::vector<double> activations(rig.bodies.size(), 0);
    const std::vector<Pose> poses(rig.bodies.size(), Pose::Identity());
    placeBodies(rig, activations, poses, {}, scene);
    parallelFor(rig.rows.size(), [&](std::size_t r) { measureAtRest(rig, scene, rig.rows[r]); });
    std::vector<std::vector<std::uint32_t>> rowsOf(rig.bodies.size());
    for (std::uint32_t r = 0; r < rig.rows.size(); ++r)
        if (ofMuscle(rig, rig.rows[r])) rowsOf[rig.rows[r].body].push_back(r);
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        const std::vector<double>& nodes = rig.bodies[m].nodes;
        for (std::size_t n = 0; n < nodes.size() && !rowsOf[m].empty(); ++n) {
            activations[m] = nodes[n];
            placeBodies(rig, activations, poses, {}, scene);
            for (const std::uint32_t r : rowsOf[m]) {
                const SkinRow& row = rig.rows[r];
                measureClearance(rig, scene, row,
                                 &rig.clearances[row.clearance + n * (row.last - row.first)]);
            }
        }
        activations[m] = 0;
        for (const std::uint32_t r : rowsOf[m])
            boundBetweenNodes(rig.clearances.data() + rig.rows[r].clearance, nodes.size(),
                              rig.rows[r].last - rig.rows[r].first);
    }
}

} // namespace tss
