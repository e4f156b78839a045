#include "bake/respond/SkinRows.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/respond/SkinContact.h"

#include <algorithm>
#include <set>

namespace tss {
namespace {

using Vec3f = Eigen::Vector3f;

/// found: per vertex. outside: of bodies' vertices; empty: of the skin's own.
void addRowsOf(SkinRig& rig, const std::vector<std::vector<int>>& found, const std::vector<char>& outside,
               std::vector<bool>& pushed) {
    const bool onSkin = outside.empty();
    std::uint32_t body = 0;
    for (std::uint32_t v = 0; v < found.size(); ++v) {
        while (!onSkin && v >= rig.bodies[body].first + rig.bodies[body].count) ++body;
        if (found[v].empty()) continue;
        SkinRow& row = rig.rows.emplace_back();
        row.kind = onSkin ? SkinContactKind::SkinOnSkin : SkinContactKind::BodyOnSkin;
        row.vertex = v;
        row.body = body;
        row.first = static_cast<std::uint32_t>(rig.starts.size());
        rig.starts.insert(rig.starts.end(), found[v].begin(), found[v].end());
        row.last = static_cast<std::uint32_t>(rig.starts.size());
        row.insideAtRest = !onSkin && outside[v] != 0;
        for (const int t : found[v])
            for (const int corner : rig.triangles[t]) pushed[corner] = true;
        if (onSkin) pushed[v] = true;
    }
}

/// How far a vertex that is tested against the skin is from the nearest of the planes of its start triangles.
float heightOverStarts(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const Vec3f x = vertexPlace(scene, row);
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const Tri& t = rig.triangles[rig.starts[k]];
        const auto edge = [&](int c) -> Vec3f { return (scene.skin[t[c]] - scene.skin[t[0]]).head<3>(); };
        const Vec3f normal = edge(1).cross(edge(2)).normalized();
        least = std::min(least, std::abs(normal.dot(x - scene.skin[t[0]].head<3>())));
    }
    return least;
}

/// Sets the clearances of a row at rest or at one node of its muscle, which the scene is at.
void measureClearance(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, Move* starts) {
    measureOffsets(rig, scene, row, starts);
    const SkinPlane plane = queryContact(rig, scene, row);
    float& gap = (*starts)[3];
    gap = starts->head<3>().norm();
    if (plane.found)
        gap = std::clamp(plane.distance, 0.0f, gap);
    else if (row.kind != SkinContactKind::SkinOnBody) // the surface faces another way
        gap = heightOverStarts(rig, scene, row);
}

/// Lowers the gap of each node to one that holds for all activations up to the next node.
void boundBetweenNodes(Move* at, std::size_t nodes, std::size_t starts) {
    for (std::size_t n = 0; n + 1 < nodes; ++n, at += starts) {
        float step = 0;
        for (std::size_t k = 0; k < starts; ++k)
            step = std::max(step, (at[starts + k] - at[k]).head<3>().norm());
        at[0][3] = std::max(std::min(at[0][3], at[starts][3]) - step / 2, 0.0f);
    }
}

/// Measures a row at rest: overlap, the surface's normal at the anchor, and, unless it is a muscle's, its
/// clearance.
void measureAtRest(SkinRig& rig, const SkinScene& scene, SkinRow& row) {
    const bool onBody = row.kind == SkinContactKind::SkinOnBody;
    const SkinBody& body = rig.bodies[row.body];
    for (int k = 0; k < 3 && onBody; ++k)
        row.facing +=
            row.weights[k] * scene.normals[body.first + body.triangles[rig.starts[row.first]][k]].head<3>();
    if (row.facing.squaredNorm() > 0) row.facing.normalize();
    Move& clearance = rig.clearances[clearancesAtRest(rig, row)];
    measureOffsets(rig, scene, row, &clearance);
    row.offset = -1; // so that the query trusts an overlap of any depth
    SkinPlane plane = queryContact(rig, scene, row, 0);
    row.offset = 0;
    if (onBody && row.insideAtRest && plane.found && plane.distance > 0) {
        row.flipped = true;
        plane = queryContact(rig, scene, row, 0);
    }
    const bool onBone = onBody && body.bone();
    if (plane.found && (row.insideAtRest || !onBone)) row.offset = std::min(plane.distance, 0.0f);
    if (!onBone) return measureClearance(rig, scene, row, &clearance);
    // No contact before the vertex has moved by its distance from the bone.
    const Vec3 x = scene.skin[row.vertex].head<3>().cast<double>();
    clearance[3] = row.insideAtRest ? 0 : static_cast<float>(body.locator->nearest(x, infinity).distance);
}

/// Whether the nearest point of a bone lies before the outer side of a skin vertex, and faces it.
bool facesFromOutside(const TriangleMesh& bone, const NearestPoint& near, const Vec3& x, const Vec3& own) {
    const Vec3 normal = bone.areaNormal(static_cast<std::size_t>(near.triangle)).normalized(),
               away = x - near.point;
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
    for (const auto& [vertex, body] : known) rows.push_back({.vertex = vertex, .body = body});
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
    addRowsOf(rig, found.bodies, found.outside, pushed);
    addRowsOf(rig, found.folds, {}, pushed);
    return pushed;
}

void measureRows(SkinRig& rig) {
    const auto isOf = [](const SkinRow& row, std::size_t body) {
        return row.kind != SkinContactKind::SkinOnSkin && row.body == body;
    };
    for (SkinRow& row : rig.rows) {
        row.clearance = static_cast<std::uint32_t>(rig.clearances.size());
        const std::size_t nodes = isOf(row, row.body) ? rig.bodies[row.body].nodes.size() : 1;
        rig.clearances.resize(rig.clearances.size() + nodes * (row.last - row.first), Move::Zero());
    }
    SkinScene scene;
    std::vector<double> activations(rig.bodies.size(), 0);
    const std::vector<Pose> poses(rig.bodies.size(), Pose::Identity());
    placeBodies(rig, activations, poses, {}, scene);
    parallelFor(rig.rows.size(), [&](std::size_t r) { measureAtRest(rig, scene, rig.rows[r]); });
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        if (rig.bodies[m].bone()) continue;
        const std::vector<double>& nodes = rig.bodies[m].nodes;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            activations[m] = nodes[n];
            placeBodies(rig, activations, poses, {}, scene);
            for (const SkinRow& row : rig.rows)
                if (isOf(row, m))
                    measureClearance(rig, scene, row,
                                     &rig.clearances[row.clearance + n * (row.last - row.first)]);
        }
        activations[m] = 0;
        for (const SkinRow& row : rig.rows)
            if (isOf(row, m))
                boundBetweenNodes(&rig.clearances[row.clearance], nodes.size(), row.last - row.first);
    }
}

} // namespace tss
