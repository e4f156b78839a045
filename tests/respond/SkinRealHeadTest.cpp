#include "RealSkins.h"
#include "SkinMeasure.h"
#include "SkinShapes.h"

#include "bake/bind/MuscleShares.h"
#include "bake/geometry/FibreLine.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/respond/SkinFollowMeasure.h"
#include "bake/respond/SkinResponse.h"

#include <iostream>

using namespace tss;
using skins::boneOf;
using skins::degree;

namespace {

/// A skin over a bone that stays and one that swings about a hinge, by no more than their names.
struct Jaw {
    TriangleMesh skin;
    std::vector<std::shared_ptr<const MuscleDeformer>> bones;
    Vec3 origin, axis;

    Pose swung(double angle) const {
        return Pose(Eigen::Translation3d(origin) * Eigen::AngleAxisd(angle, axis) *
                    Eigen::Translation3d(-origin));
    }
};

Jaw realJaw() {
    Jaw jaw{skins::realSkin("dog_face/skin_head.obj"), {}, Vec3(0.30549, 0, 0.68499), Vec3::UnitY()};
    TriangleMesh mandible = skins::realSkin("dog_jaw/mandible.obj");
    for (Vec3& v : mandible.vertices) v += Vec3(-0.001, 0, -0.002); // as the fitted joint has it
    jaw.bones = {boneOf(skins::realSkin("dog_jaw/skull.obj")), boneOf(std::move(mandible))};
    return jaw;
}

} // namespace

TEST_CASE("a real head's skin knows which bone carries it, by their names alone") {
    REQUIRE_SHARED_MESHES();
    const Jaw jaw = realJaw();
    SkinParameters parameters;
    parameters.swings = {{{Pose::Identity(), jaw.swung(14 * degree)}},
                         {{Pose::Identity(), jaw.swung(-18 * degree)}}};
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    SkinResponse response(makeSkinRig(jaw.skin, jaw.bones, nothingMet, parameters));
    const SkinFollowMeasure measure(jaw.skin, jaw.bones, response.rig());
    for (const double degrees : {14.0, -18.0}) {
        const std::vector<Pose> poses{Pose::Identity(), jaw.swung(degrees * degree)};
        response.update(std::vector<double>{0, 0}, poses);
        const SkinFollowing f = measure.at(response.positions(), poses);
        const SkinFollowing::OnBone &still = f.bones[0], &along = f.bones[1];
        std::cout << "real head, jaw by " << degrees << " degrees: skin on the skull moves " << still.mean
                  << " (95 %: " << still.most << "), on the mandible is " << along.mean << " (" << along.most
                  << ") off, in thousandths; edges " << f.shortest << " to " << f.longest
                  << " (1st and 99th percentile), turned over " << f.turnedOver << '\n';
        CHECK(still.vertices > 500);
        CHECK(along.vertices > 500);
        CHECK(still.mean <= 0.3);
        CHECK(still.most <= 1.5);
        CHECK(along.mean <= 0.8);
        CHECK(along.most <= 4);
        CHECK(f.shortest >= 0.45);
        CHECK(f.longest <= 1.6);
        // Shut all the way, the upper molars push the back of the mouth by 7 mm.
        CHECK(f.turnedOver <= (degrees < 0 ? 3 : 0));
    }
}

TEST_CASE("a human face over two rows of teeth opens its mouth: each lip goes with its own") {
    REQUIRE_SHARED_MESHES();
    const Jaw jaw{skins::realSkin("human_face_ict/face.obj"),
                  {boneOf(skins::realSkin("human_jaw_ict/upper_teeth.obj")),
                   boneOf(skins::realSkin("human_jaw_ict/lower_teeth.obj"))},
                  Vec3(0, -0.547, 1.819),
                  Vec3::UnitX()};
    const Pose open = jaw.swung(25.3 * degree);
    SkinParameters parameters;
    parameters.swings = {{{Pose::Identity(), open}}};
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    SkinResponse response(makeSkinRig(jaw.skin, jaw.bones, nothingMet, parameters));
    const std::vector<Pose> poses{Pose::Identity(), open};
    response.update(std::vector<double>{0, 0}, poses);
    const SkinFollowing f =
        SkinFollowMeasure(jaw.skin, jaw.bones, response.rig()).at(response.positions(), poses);
    double upper = 0, lower = 1;
    int lips = 0;
    for (std::size_t v = 0; v < response.positions().size(); ++v) {
        const Vec3& rest = response.rig().rest[v];
        if (std::abs(rest.x()) > 1 || rest.z() < 11) continue; // cm, of the middle of the red of the lips
        const double along = (response.positions()[v] - rest).norm() / (open * rest - rest).norm();
        if (rest.y() > -3.3 && rest.y() < -2.5) upper = std::max(upper, along);
        if (rest.y() < -3.42 && rest.y() > -4.5) lower = std::min(lower, along);
        ++lips;
    }
    std::cout << "human face, jaw by 25.3 degrees: the upper lip makes up to " << upper
              << " of the lower teeth's motion, the lower lip at least " << lower << "; edges " << f.shortest
              << " to " << f.longest << " (1st and 99th percentile), turned over " << f.turnedOver << '\n';
    CHECK(lips > 100);
    CHECK(upper <= 0.2);
    CHECK(lower >= 0.7); // three vertices that the upper teeth had by chance held it back at 0.63
    CHECK(f.turnedOver == 0);
}

TEST_CASE(
    "chewing muscles and rings between skull and mandible move with both, and drag the skin of neither") {
    REQUIRE_SHARED_MESHES();
    Jaw jaw = realJaw();
    SkinParameters parameters;
    parameters.frames = {0, 1};
    parameters.chains = {{}, {}};
    for (const char* name : {"masseter_L", "masseter_R", "temporalis_L", "temporalis_R", "orbicularis_oris_L",
                             "orbicularis_oris_R"}) {
        Muscle muscle;
        muscle.surface = skins::realSkin(std::string("dog_face/") + name + ".obj");
        muscle.spans = true;
        if (std::string(name).starts_with("orb")) {
            muscle.form = MuscleForm::Ring;
            muscle.fibre = ringLine(muscle.surface);
        } else {
            muscle.fibre = fibreLine(muscle.surface);
        }
        std::vector<std::vector<DualPose>> motions;
        for (const double degrees : {7.0, 14.0, -9.0, -18.0})
            motions.push_back({DualPose(jaw.swung(degrees * degree))});
        const std::vector bones{jaw.bones[0]->muscle().surface, jaw.bones[1]->muscle().surface};
        muscle.chainShares = chainShares(muscle.surface, bones, muscle.form, motions);
        jaw.bones.push_back(std::make_shared<const MuscleDeformer>(std::move(muscle)));
        parameters.frames.push_back(0);
        parameters.chains.push_back({1});
    }
    const auto posesAt = [&](double degrees) {
        std::vector<Pose> poses(jaw.bones.size(), Pose::Identity());
        poses[1] = jaw.swung(degrees * degree);
        return poses;
    };
    parameters.swings = {{posesAt(7), posesAt(14)}, {posesAt(-9), posesAt(-18)}};
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    SkinResponse response(makeSkinRig(jaw.skin, jaw.bones, nothingMet, parameters));
    const SkinFollowMeasure measure(jaw.skin, jaw.bones, response.rig());
    const skins::Couple couple{jaw.skin, {}, {}};
    for (const double degrees : {7.0, 14.0, -9.0, -15.0, -18.0}) {
        const std::vector<Pose> poses = posesAt(degrees);
        response.update(std::vector<double>(poses.size(), 0), poses);
        const SkinFollowing f = measure.at(response.positions(), poses);
        const TriangleMesh skin{skins::places(couple, response), jaw.skin.triangles};
        double out = 0, volume = 0;
        for (std::size_t m = 2; m < jaw.bones.size(); ++m) {
            const MuscleDeformer& muscle = *jaw.bones[m];
            const std::vector<Vec3> now = MuscleShape(muscle).vertices(0, {poses[1]});
            volume = std::max(
                volume,
                std::abs(enclosedVolume(now, muscle.muscle().surface.triangles) / muscle.restVolume() - 1));
            out = std::max(out, skins::beyond(skins::poking(now, skin, 0.01),
                                              skins::poking(muscle.vertices(0.0), jaw.skin, 0.01))
                                    .worst);
        }
        std::cout << "real head and six muscles, jaw by " << degrees << " degrees: skin on the skull moves "
                  << f.bones[0].mean << " (95 %: " << f.bones[0].most << "), on the mandible is "
                  << f.bones[1].mean << " (" << f.bones[1].most << ") off; edges " << f.shortest << " to "
                  << f.longest << ", turned over " << f.turnedOver << ", muscles through skin by up to "
                  << 1000 * out << " mm more than at rest, volume " << volume << " off\n";
        CHECK(volume < 1e-9);
        CHECK(f.bones[0].mean <= 0.3);
        CHECK(f.bones[0].most <= 1.5);
        CHECK(f.bones[1].mean <= 0.8); // half a ring that moved with the skull dragged it by 15
        CHECK(f.bones[1].most <= 4);
        // Shut all the way, molars push the lining of the mouth against each other.
        CHECK(f.turnedOver <= (degrees < -15 ? 4 : 0));
        // Beyond, the rings are between the teeth. With at most 8 rounds of contact it was 0.060 at -15.
        if (degrees >= -15) CHECK(out <= 0.05e-3);
    }
}

TEST_CASE("a bone may be any mesh: open, of several shells, inside out") {
    TriangleMesh open = skins::vaultedSheet(8, 0.4, -0.05, 0.1);
    for (Tri& t : open.triangles) std::swap(t[0], t[1]);
    const auto first = static_cast<int>(open.vertices.size());
    const TriangleMesh other = skins::vaultedSheet(4, 0.2, -0.2, 0);
    open.vertices.insert(open.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Tri& t : other.triangles) open.triangles.push_back(t.array() + first);
    Muscle bone;
    bone.surface = open;
    bone.activationUpper = 0;
    const skins::Couple couple = skins::couple(skins::vaultedSheet(32, 1, 0.01, 0.3), {bone});
    REQUIRE(couple.muscles[0]->rigid());
    SkinResponse response(couple.rig());
    Pose pose = Pose::Identity();
    pose.translation() = Vec3(0.02, 0, 0.05);
    response.update(std::vector<double>{0}, std::vector<Pose>{pose});
    int above = 0;
    for (std::size_t v = 0; v < response.positions().size(); ++v) {
        const Vec3& rest = response.rig().rest[v];
        if (rest.head<2>().norm() > 0.2) continue;
        ++above;
        CHECK((response.positions()[v] - pose * rest).norm() < 0.005);
    }
    CHECK(above > 30);
}
