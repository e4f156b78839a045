#include "bake/scene/SceneReading.h"

#include <set>

namespace tss {

namespace {

/// Xforms that are bodies: rigid ones, and those that a joint, a muscle or a skin names.
std::set<std::string> namedBodies(const SceneReading& reading) {
    std::set<std::string> named;
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        for (const char* relationship : {schema::body0, schema::body1, schema::bodies, schema::bone,
                                         schema::originBone, schema::insertionBone, schema::bones}) {
            const Property* property = reading.index.entries[i].prim->property(relationship);
            if (property && property->isRelationship())
                for (const std::string& path : listItems(*property->targetPaths)) named.insert(path);
        }
        if (!hasApi(*reading.index.entries[i].prim, "TssSkinAPI")) continue;
        const Property* joints = reading.index.entries[i].prim->property(schema::skelJoints.name);
        if (joints && joints->defaultValue)
            for (const std::string& path : listItems(*joints->defaultValue)) named.insert(path);
    }
    return named;
}

void checkCounts(const PrimReader& prim, std::size_t corners, std::size_t indices) {
    if (corners != indices)
        prim.problem(schema::faceVertexIndices, "expected " + std::to_string(corners) +
                                                    " indices, the sum of faceVertexCounts, found " +
                                                    std::to_string(indices));
}

/// Faces cut into triangles from their first corner.
std::vector<Tri> readTriangles(const PrimReader& prim, std::size_t vertices) {
    std::vector<Tri> triangles;
    const auto counts = prim.reals(schema::faceVertexCounts, Range{3, 1e6});
    const auto indices = prim.indices(schema::faceVertexIndices);
    std::size_t corners = 0;
    for (double count : counts) corners += static_cast<std::size_t>(count);
    if (corners != indices.size()) {
        checkCounts(prim, corners, indices.size());
        return triangles;
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertices) {
            prim.problem(schema::faceVertexIndices, "expected indices below " + std::to_string(vertices) +
                                                        ", the number of points, found " +
                                                        std::to_string(indices[i]) + " at index " +
                                                        std::to_string(i));
            return triangles;
        }
    triangles.reserve(corners - 2 * counts.size());
    std::size_t first = 0;
    for (double count : counts) {
        for (std::size_t k = 2; k < static_cast<std::size_t>(count); ++k)
            triangles.emplace_back(indices[first], indices[first + k - 1], indices[first + k]);
        first += static_cast<std::size_t>(count);
    }
    return triangles;
}

std::string originalName(const Prim& prim) {
    const auto data = prim.metadata.find("customData");
    const auto* object = data == prim.metadata.end() ? nullptr : data->second.as<Value::Object>();
    const auto name = object ? object->find(schema::originalName) : Value::Object::const_iterator();
    const auto* text = object && name != object->end() ? name->second.as<std::string>() : nullptr;
    return text ? *text : std::string();
}

Vec3 readColor(const PrimReader& prim, const Vec3& fallback) {
    const auto colors = prim.vectors(schema::displayColor);
    return colors.empty() ? fallback : colors.front();
}

/// USD physics does not allow a rigid body within another, unless its transform starts anew.
void checkNesting(const SceneReading& reading, std::size_t entry, const std::vector<bool>& rigid) {
    if (!rigid[entry]) return;
    for (int at = static_cast<int>(entry); at >= 0; at = reading.index.entries[at].parent) {
        if (at != static_cast<int>(entry) && rigid[at]) {
            reading.problems.add(reading.index.entries[entry].place,
                                 "expected rigid bodies side by side, found this one inside of " +
                                     reading.index.entries[at].place.path);
            return;
        }
        if (resetsXformStack(reading.reader(at))) return;
    }
}

Body readBody(const PrimReader& prim, const PrimEntry& entry, const SplitXform& xform) {
    Body body;
    body.path = entry.place.path;
    body.displayName = originalName(prim.prim());
    body.placement = xform.placement;
    body.visible = entry.visible;
    body.rigid = hasApi(prim.prim(), "PhysicsRigidBodyAPI");
    if (prim.prim().typeName == "Mesh") {
        body.mesh = readMesh(prim, xform);
        body.displayColor = readColor(prim, body.displayColor);
        body.doubleSided = prim.flag(schema::doubleSided, false);
        prim.choice(schema::visibility, {"inherited", "invisible"});
    }
    return body;
}

} // namespace

std::vector<Xform> worldXforms(const SceneReading& reading) {
    std::vector<Xform> world;
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        const PrimReader prim = reading.reader(static_cast<int>(i));
        const int parent = reading.index.entries[i].parent;
        Xform xform = localXform(prim);
        if (parent >= 0 && !resetsXformStack(prim)) {
            xform.matrix = world[parent].matrix * xform.matrix;
            xform.rigid = world[parent].rigid && xform.rigid;
        }
        world.push_back(xform);
    }
    return world;
}

TriangleMesh readMesh(const PrimReader& prim, const SplitXform& xform) {
    TriangleMesh mesh;
    mesh.vertices = prim.vectors(schema::points);
    mesh.triangles = readTriangles(prim, mesh.vertices.size());
    if (xform.stretched)
        for (Vec3& vertex : mesh.vertices) vertex = xform.stretch * vertex;
    const bool leftHanded = prim.choice(schema::orientation, {"rightHanded", "leftHanded"}) == "leftHanded";
    const bool mirrored = xform.stretched && xform.stretch.determinant() < 0;
    if (leftHanded != mirrored)
        for (Tri& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    return mesh;
}

void readBodies(SceneReading& reading) {
    const auto named = namedBodies(reading);
    const auto world = worldXforms(reading);
    std::vector<bool> rigid(world.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
        const PrimEntry& entry = reading.index.entries[i];
        rigid[i] = hasApi(*entry.prim, "PhysicsRigidBodyAPI");
        checkNesting(reading, i, rigid);
        const bool frame = entry.prim->typeName == "Xform" && (rigid[i] || named.contains(entry.place.path));
        if (entry.prim->typeName != "Mesh" && !frame) continue;
        if (!(std::abs(world[i].matrix.linear().determinant()) > 0)) {
            reading.problems.add(entry.place, "expected a transform that can be inverted");
            continue;
        }
        const SplitXform xform = split(world[i]);
        reading.bodyAt[entry.place.path] = static_cast<int>(reading.scene.bodies.size());
        reading.scene.bodies.push_back(readBody(reading.reader(static_cast<int>(i)), entry, xform));
        reading.bodyXforms.push_back(xform);
    }
}

} // namespace tss
