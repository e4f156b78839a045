#include "bake/geometry/MeshAudit.h"
#include "bake/scene/SceneFile.h"
#include "examples/doghead/DogMeshes.h"
#include "examples/doghead/DogScenes.h"
#include "examples/doghead/anatomy/Anatomy.h"
#include "examples/doghead/mesh/EditableMesh.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace doghead;

namespace {

const std::string scenes = std::string(OSGTSS_SOURCE_DIR) + "/scenes/";
constexpr double degree = M_PI / 180;

/// The jaw of the committed scene against the solids that its meshes were made from.
struct Jaw {
    tss::SceneModel scene = tss::loadScene(scenes + "dog_jaw.tss");
    const TriangleMesh& skullMesh = scene.bodies.at(tss::findBody(scene, "/DogJaw/Skull")).mesh;
    const TriangleMesh& mandibleMesh = scene.bodies.at(tss::findBody(scene, "/DogJaw/Mandible")).mesh;
    tss::Motion motion = tss::pairMotion(scene, scene.pairs.at(0));
    Field skullField = skull(), mandibleField = mandible();

    struct Gap {
        double value = 1e9; ///< mm, negative where the solids overlap
        Vec3 at;
    };

    /// The least distance of a vertex of one bone from the other bone, among the vertices from `from` to `to`
    /// in x.
    Gap gap(double lateral, double open, double from = -1e9, double to = 1e9) const {
        const double q[] = {lateral * degree, open * degree};
        const tss::Pose toSkull = tss::pose(motion, q), toMandible = toSkull.inverse();
        Gap least;
        const auto see = [&](const Vec3& place, double distance) {
            if (distance < least.value && place.x() >= from && place.x() <= to) least = {distance, place};
        };
        for (const Vec3& v : mandibleMesh.vertices) see(toSkull * v, skullField(toSkull * v));
        for (const Vec3& v : skullMesh.vertices) see(v, mandibleField(toMandible * v));
        return least;
    }
};

} // namespace

TEST_CASE("the bones of the dog's jaw are closed, face outwards and have no slivers") {
    const Jaw jaw;
    CHECK(jaw.skullMesh.triangles.size() + jaw.mandibleMesh.triangles.size() < 27000);
    CHECK(std::filesystem::file_size(scenes + "dog_jaw.tss") < 2'500'000);
    for (const TriangleMesh* mesh : {&jaw.skullMesh, &jaw.mandibleMesh}) {
        const tss::MeshAudit audit = tss::auditMesh(*mesh);
        INFO(tss::text(audit));
        CHECK(audit.watertight);
        CHECK(audit.components == 1);
        CHECK(audit.signedVolume > 0);
        CHECK(audit.zeroAreaTriangles == 0);
        for (std::size_t i = 0; i < mesh->triangles.size(); ++i)
            CHECK(quality(mesh->corner(i, 0), mesh->corner(i, 1), mesh->corner(i, 2)) > 0.1);
    }
    const Vec3 size = bounds(jaw.skullMesh).sizes();
    CHECK(size.x() == Approx(174).margin(6)); // mm, of a dog
    CHECK(size.y() == Approx(98).margin(4));
}

TEST_CASE("the teeth meet inside the jaw's limits") {
    const Jaw jaw;
    REQUIRE(jaw.motion.dofs.size() == 2);
    const tss::Dof& open = jaw.motion.dofs[1];
    CHECK(jaw.gap(0, open.rest / degree).value > 0.2);
    CHECK(jaw.gap(0, open.upper / degree).value > 0.2);
    CHECK(jaw.gap(0, open.lower / degree).value < -0.5);

    double free = open.rest / degree, hit = open.lower / degree;
    while (free - hit > 0.01) {
        const double middle = (free + hit) / 2;
        (jaw.gap(0, middle).value > 0 ? free : hit) = middle;
    }
    CHECK(free == Approx(0).margin(1.5)); // closed is where the teeth meet
    CHECK(jaw.gap(0, hit).at.x() > 40);   // and it is teeth that do
}

TEST_CASE("grinding to either side brings the canines together") {
    const Jaw jaw;
    for (const double side : {-1., 1.}) {
        REQUIRE(jaw.gap(0, 2).value > 0);
        const Jaw::Gap ground = jaw.gap(2.5 * side, 2);
        CHECK(ground.value < 0);
        CHECK(ground.at.x() > 110);
        CHECK(std::abs(ground.at.y()) > 12);
    }
}

TEST_CASE("the condyles turn freely in their sockets") {
    const Jaw jaw;
    for (const tss::Dof& dof : jaw.motion.dofs) CHECK(dof.upper > dof.lower);
    for (const double lateral : {jaw.motion.dofs[0].lower, 0., jaw.motion.dofs[0].upper})
        for (const double open : {0., jaw.motion.dofs[1].rest, jaw.motion.dofs[1].upper}) {
            INFO("lateral " << lateral / degree << " open " << open / degree);
            const Jaw::Gap gap = jaw.gap(lateral / degree, open / degree, -1e9, 30);
            CHECK(gap.value > 0.05);
            CHECK(gap.value < 3); // they sit in them
        }
}

TEST_CASE("the frontalis lies between skull and skin") {
    const tss::SceneModel scene = tss::loadScene(scenes + "dog_frontalis.tss");
    REQUIRE(scene.muscles.size() == 1);
    REQUIRE(scene.skins.size() == 1);
    const tss::Muscle& muscle = scene.muscles[0].muscle;
    const tss::MeshAudit audit = tss::auditMesh(muscle.surface);
    INFO(tss::text(audit));
    CHECK(audit.watertight);
    CHECK(audit.components == 1);
    CHECK(audit.signedVolume > 0);

    const Field bone = cranium(), skin = headSkin(), sheet = frontalis();
    for (const Vec3& v : muscle.surface.vertices) {
        CHECK(bone(v) > 0);
        CHECK(skin(v) < -0.3);
    }
    for (const Vec3& v : muscle.fibre) CHECK(sheet(v) < 0.3);

    const tss::SkinModel& model = scene.skins[0];
    const TriangleMesh& surface = scene.bodies.at(model.body).mesh;
    REQUIRE(model.tether.size() == surface.vertices.size());
    CHECK(tss::auditMesh(surface).openEdges > 0);
    CHECK(tss::auditMesh(surface).nonManifoldEdges == 0);
    CHECK(tss::auditMesh(surface).misorientedEdges == 0);
    int free = 0, held = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        free += model.tether[i] == 0;
        held += model.tether[i] == 1;
    }
    CHECK(free > 200);
    CHECK(held > 1000);
}

TEST_CASE("the committed scenes are what the generator writes", "[.long]") {
    const std::filesystem::path folder = std::filesystem::path(OSGTSS_BINARY_DIR) / "test_dog";
    std::filesystem::create_directories(folder);
    const auto bytes = [](const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    for (const auto& [name, scene] : {std::pair("dog_jaw.tss", jawScene()),
                                      {"dog_frontalis.tss", frontalisScene()},
                                      {"dog_face.tss", faceScene()},
                                      {"dog_ears.tss", earsScene()},
                                      {"dog_lips.tss", lipsScene()},
                                      {"dog_head.tss", headScene()}}) {
        tss::saveScene(scene, (folder / name).string());
        CHECK(bytes(folder / name) == bytes(scenes + name));
    }
}
