#include "RealSkins.h"
#include "SkinMeasure.h"

#include "bake/respond/SkinCarry.h"

#include <iostream>

using namespace tss;

namespace {

constexpr double degree = M_PI / 180;

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

std::shared_ptr<const MuscleDeformer> boneOf(TriangleMesh mesh) {
    Muscle bone;
    bone.surface = std::move(mesh);
    bone.activationUpper = 0;
    return std::make_shared<const MuscleDeformer>(std::move(bone));
}

Jaw realJaw() {
    Jaw jaw{skins::realSkin("dog_face/skin_head.obj"), {}, Vec3(0.30549, 0, 0.68499), Vec3::UnitY()};
    TriangleMesh mandible = skins::realSkin("dog_jaw/mandible.obj");
    for (Vec3& v : mandible.vertices) v += Vec3(-0.001, 0, -0.002); // as the fitted joint has it
    jaw.bones = {boneOf(skins::realSkin("dog_jaw/skull.obj")), boneOf(std::move(mandible))};
    return jaw;
}

double at(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
    return values[place];
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v / static_cast<double>(values.size());
    return sum;
}

/// In thousandths of the bones' bounding diagonal.
struct Carried {
    std::vector<double> still, along; ///< move of skin on the fixed bone alone; off the other bone's motion
    std::vector<double> edges;        ///< of their length at rest
    int flips = 0;                    ///< triangles turned over against the skin's own turn
};

Carried measure(const Jaw& jaw, const SkinGround& ground, const SkinCarriage& carriage, double angle) {
    Eigen::AlignedBox3d box;
    for (const auto& bone : jaw.bones) box.extend(bounds(bone->muscle().surface));
    const double size = box.diagonal().norm();
    const Pose pose = jaw.swung(angle);
    const DualPose swing(pose);
    Carried result;
    std::vector<Vec3> now;
    std::vector<Pose> turns;
    for (std::size_t v = 0; v < jaw.skin.vertices.size(); ++v) {
        const Vec3& x = jaw.skin.vertices[v];
        PoseBlend blend;
        blend.add(carriage.frames[1][v], swing);
        turns.push_back(blend.pose());
        now.push_back(turns.back() * x);
        const double fixed = ground.locators[0].nearest(x, 1e9).distance / size,
                     moving = ground.locators[1].nearest(x, 1e9).distance / size;
        if (fixed < 1 / 30.0 && moving > 1 / 9.0) result.still.push_back(1000 * (now[v] - x).norm() / size);
        if (moving < 1 / 30.0 && fixed > 1 / 9.0)
            result.along.push_back(1000 * (now[v] - pose * x).norm() / size);
    }
    for (const Tri& t : jaw.skin.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int i = t[k], j = t[(k + 1) % 3];
            const double rest = (jaw.skin.vertices[i] - jaw.skin.vertices[j]).norm();
            if (rest > 1e-5 * size) result.edges.push_back((now[i] - now[j]).norm() / rest);
        }
        const auto& x = jaw.skin.vertices;
        const Vec3 before = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]),
                   after = (now[t[1]] - now[t[0]]).cross(now[t[2]] - now[t[0]]);
        result.flips += after.dot(turns[t[0]].linear() * before) < 0;
    }
    return result;
}

} // namespace

TEST_CASE("a real head's skin knows which bone carries it, by their names alone") {
    REQUIRE_SHARED_MESHES();
    const Jaw jaw = realJaw();
    const SkinGround ground(jaw.skin, jaw.bones);
    SkinParameters parameters;
    parameters.swings = {{{Pose::Identity(), jaw.swung(14 * degree)}}};
    const SkinCarriage carriage = carrySkin(ground, parameters);
    for (const double degrees : {14.0, -18.0}) {
        const Carried c = measure(jaw, ground, carriage, degrees * degree);
        std::cout << "real head, jaw by " << degrees << " degrees: skin on the skull moves " << mean(c.still)
                  << " (95 %: " << at(c.still, 0.95) << "), on the mandible is " << mean(c.along) << " ("
                  << at(c.along, 0.95) << ") off, in thousandths; edges " << at(c.edges, 0.01) << " to "
                  << at(c.edges, 0.99) << " (1st and 99th percentile), turned over " << c.flips << '\n';
        CHECK(mean(c.still) <= 0.3);
        CHECK(at(c.still, 0.95) <= 1.5);
        CHECK(mean(c.along) <= 0.8);
        CHECK(at(c.along, 0.95) <= 4);
        CHECK(at(c.edges, 0.01) >= 0.5);
        CHECK(at(c.edges, 0.99) <= 1.6);
        CHECK(c.flips == 0);
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
