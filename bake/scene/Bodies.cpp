#include "bake/base/Order.h"
#include "bake/geometry/Polygon.h"
#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <set>

namespace tss {

namespace {

constexpr Attribute orientation =
    declared("uniform token orientation", "", anyNumber, "rightHanded leftHanded");

const Fields<Body>& meshFields() {
    static const Fields<Body> fields{
        schema::points,
        schema::faceVertexCounts,
        schema::faceVertexIndices,
        orientation,
        schema::subdivisionScheme,
        schema::extent,
        {schema::displayColor,
         [](const PrimReader& prim, const Attribute& attribute, Body& body) {
             if (const auto colors = prim.vectors(attribute); !colors.empty())
                 body.displayColor = colors.front();
         },
         [](PrimWriter& prim, const Attribute& attribute, const Body& body) {
             prim.set(attribute, std::vector<Vec3>{body.displayColor});
         }},
        field("uniform bool doubleSided", &Body::doubleSided, false, anyNumber, "")};
    return fields;
}

/// Xforms that are bodies: rigid ones, and those that a joint, a muscle or a skin names.
std::set<std::string> namedBodies(const SceneReading& reading) {
    std::set<std::string> named;
    const auto add = [&](const Value& paths) {
        for (const std::string& path : listItems(paths)) named.insert(path);
    };
    for (const PrimEntry& entry : reading.index.entries) {
        using namespace schema;
        for (const Attribute& relationship :
             {body0, body1, schema::bodies, bone, originBone, insertionBone, bones})
            if (const Property* property = entry.prim->property(relationship.name);
                property && property->isRelationship())
                add(*property->targetPaths);
        const Property* joints = entry.prim->property(skelJoints.name);
        if (joints && joints->defaultValue && hasApi(*entry.prim, "TssSkinAPI")) add(*joints->defaultValue);
    }
    return named;
}

/// Faces cut into triangles.
std::vector<Tri> readTriangles(const PrimReader& prim, const std::vector<Vec3>& points) {
    std::vector<Tri> triangles;
    const auto counts = prim.reals(schema::faceVertexCounts);
    const auto indices = prim.indices(schema::faceVertexIndices);
    std::size_t corners = 0;
    for (double count : counts) corners += static_cast<std::size_t>(count);
    if (corners != indices.size()) {
        prim.problem(schema::faceVertexIndices, "expected ", corners,
                     " indices, the sum of faceVertexCounts, found ", indices.size());
        return triangles;
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= points.size()) {
            prim.problem(schema::faceVertexIndices, "expected indices below ", points.size(),
                         ", the number of points, found ", indices[i], " at index ", i);
            return triangles;
        }
    triangles.reserve(corners - 2 * counts.size());
    std::vector<Vec3> face;
    std::size_t first = 0;
    for (double count : counts) {
        face.clear();
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
            face.push_back(points[indices[first + k]]);
        for (const Tri& t : triangulated(face))
            triangles.emplace_back(indices[first + t[0]], indices[first + t[1]], indices[first + t[2]]);
        first += face.size();
    }
    return triangles;
}

/// USD physics does not allow a rigid body within another, unless its transform starts anew.
void checkNesting(const SceneReading& reading, std::size_t entry, const std::vector<bool>& rigid) {
    if (!rigid[entry]) return;
    for (int at = static_cast<int>(entry); at >= 0; at = reading.index.entries[at].parent) {
        if (at != static_cast<int>(entry) && rigid[at]) {
            reading.problems.add(reading.index.entries[entry].place,
                                 "expected rigid bodies side by side, found this one inside of ",
                                 reading.index.entries[at].place.path);
            return;
        }
        if (resetsXformStack(reading.reader(at))) return;
    }
}

Body readBody(const PrimReader& prim, const PrimEntry& entry, const SplitXform& xform) {
    Body body;
    body.path = entry.place.path;
    body.displayName = originalNameOf(prim.prim());
    if (const auto* data = member<Value::Object>(prim.prim().metadata, "customData"))
        if (const bool* nameless = member<bool>(*data, schema::nameless)) body.named = !*nameless;
    body.placement = xform.placement;
    body.visible = entry.visible;
    body.rigid = hasApi(prim.prim(), "PhysicsRigidBodyAPI");
    if (prim.prim().typeName == "Mesh") {
        body.mesh = readMesh(prim, xform);
        meshFields().read(prim, body);
        prim.choice(schema::visibility);
    }
    return body;
}

/// Where the nearest prim above this path that is a body stands, which its own transform is relative to.
Pose parentPlacement(const SceneModel& scene, std::string path) {
    for (auto slash = path.rfind('/'); slash != 0 && slash != std::string::npos; slash = path.rfind('/')) {
        path.resize(slash);
        if (const int body = findBody(scene, path); body >= 0) return scene.bodies[body].placement;
    }
    return Pose::Identity();
}

void writeMesh(PrimWriter& prim, const Body& body) {
    const TriangleMesh& mesh = body.mesh;
    prim.set(schema::points, mesh.vertices);
    prim.set(schema::faceVertexCounts, std::vector<double>(mesh.triangles.size(), 3));
    std::vector<double> indices;
    indices.reserve(3 * mesh.triangles.size());
    for (const Tri& triangle : mesh.triangles)
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    prim.set(schema::faceVertexIndices, indices);
    prim.set(schema::subdivisionScheme, Value("none"));
    meshFields().write(prim, body);
    const Eigen::AlignedBox3d box = bounds(mesh);
    prim.set(schema::extent, std::vector<Vec3>{box.min(), box.max()});
}

void writeBody(Layer& layer, const SceneModel& scene, const Body& body) {
    const bool hasMesh = !body.mesh.vertices.empty();
    PrimWriter prim(makePrim(layer, body.path, hasMesh ? "Mesh" : "Xform"));
    if (body.rigid) {
        addApi(prim.prim(), "PhysicsRigidBodyAPI");
        if (hasMesh) addApi(prim.prim(), "PhysicsCollisionAPI");
    }
    writeOriginalName(prim.prim(), body.displayName, body.named);
    prim.setUnless(schema::visibility, body.visible ? "inherited" : "invisible", "inherited");
    writePlacement(prim, parentPlacement(scene, body.path).inverse() * body.placement);
    if (hasMesh) writeMesh(prim, body);
}

} // namespace

std::string originalNameOf(const Prim& prim) {
    const auto* data = member<Value::Object>(prim.metadata, "customData");
    const auto* name = data ? member<std::string>(*data, schema::originalName) : nullptr;
    return name ? *name : "";
}

void writeOriginalName(Prim& prim, const std::string& name, bool named) {
    Value::Object data;
    if (!name.empty()) data.emplace(schema::originalName, Value(name));
    if (!named) data.emplace(schema::nameless, Value(true));
    if (!data.empty()) prim.metadata["customData"] = std::move(data);
}

std::vector<Xform> worldXforms(const SceneReading& reading, std::vector<std::string>* unplaced) {
    std::vector<Xform> world;
    std::vector<std::string> whys;
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        const PrimReader prim = reading.reader(static_cast<int>(i));
        const int parent = reading.index.entries[i].parent;
        Xform xform;
        std::string why;
        try {
            xform = localXform(prim);
            if (parent >= 0 && !resetsXformStack(prim)) {
                xform.matrix = world[parent].matrix * xform.matrix;
                xform.rigid = world[parent].rigid && xform.rigid;
                why = whys[parent];
            }
            if (why.empty() && !(std::abs(xform.matrix.linear().determinant()) > 0))
                why = prim.place().path + ": expected a transform that can be inverted";
        } catch (const InputError& error) {
            if (!unplaced) throw;
            why = error.where.path + ": " + error.message;
        }
        world.push_back(xform);
        whys.push_back(std::move(why));
    }
    if (unplaced) *unplaced = std::move(whys);
    return world;
}

TriangleMesh readMesh(const PrimReader& prim, const SplitXform& xform) {
    TriangleMesh mesh;
    mesh.vertices = prim.vectors(schema::points);
    mesh.triangles = readTriangles(prim, mesh.vertices);
    for (Vec3& vertex : mesh.vertices) vertex = stretched(xform, vertex);
    const bool leftHanded = prim.choice(orientation) == "leftHanded";
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

void writeBodies(Layer& layer, const SceneModel& scene) {
    // Parents first, whatever their order in the scene, so that none is made as a plain Xform by its child.
    std::vector<std::size_t> order = indicesOf<std::size_t>(scene.bodies.size());
    const auto depth = [&](std::size_t i) {
        const std::string& path = scene.bodies[i].path;
        return std::ranges::count(path, '/');
    };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
    for (std::size_t i : order) writeBody(layer, scene, scene.bodies[i]);
}

std::vector<SchemaType> bodySchemas() {
    return {meshFields().schema("Mesh"), {"Xform", {schema::visibility, schema::xformOpOrder}}};
}

} // namespace tss
