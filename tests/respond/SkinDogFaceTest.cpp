#include "RealSkins.h"
#include "SkinMeasure.h"

#include "bake/compare/PushedSkin.h"
#include "bake/geometry/MeshAudit.h"

#include <ctime>
#include <iostream>
#include <map>
#include <random>

using namespace tss;
using skins::depths;
using skins::distance;
using skins::largestMove;

namespace {

constexpr double mm = 1e-3; // the dog is in metres

TriangleMesh dogMesh(const std::string& name) {
    return skins::realSkin("dog_face/" + name + ".obj");
}

/// The mask over brow and cheeks: a sheet, its fibre along the middle of the forehead from the back of the
/// head to the nose.
Muscle frontalMask() {
    Muscle muscle;
    muscle.surface = dogMesh("orbicularis_oculi_frontal");
    muscle.form = MuscleForm::Sheet;
    muscle.fibre = {{0.300, 0, 0.743}, {0.330, 0, 0.740}, {0.360, 0, 0.733},
                    {0.375, 0, 0.724}, {0.390, 0, 0.705}, {0.420, 0, 0.689}};
    return muscle;
}

/// Any other muscle: a tube along the longest extent of its surface, anchored at the end nearer the ears.
Muscle longMuscle(const std::string& name) {
    Muscle muscle;
    muscle.surface = dogMesh(name);
    const std::vector<Vec3>& v = muscle.surface.vertices;
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : v) mean += p / static_cast<double>(v.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vec3& p : v) spread += (p - mean) * (p - mean).transpose();
    Vec3 axis = Vec3::Ones().normalized();
    for (int i = 0; i < 100; ++i) axis = (spread * axis).normalized();
    if (axis.x() < 0) axis = -axis;
    double low = 0, high = 0;
    for (const Vec3& p : v) {
        low = std::min(low, axis.dot(p - mean));
        high = std::max(high, axis.dot(p - mean));
    }
    muscle.fibre = {mean + low * axis, mean + high * axis};
    muscle.maxContraction = 0.15;
    return muscle;
}

std::vector<Muscle> allMuscles() {
    std::vector<Muscle> muscles{frontalMask()};
    muscles.front().maxContraction = 0.04;
    for (const char* name :
         {"interscutularis", "temporalis_L", "temporalis_R", "masseter_L", "masseter_R", "zygomaticus_L",
          "zygomaticus_R", "orbicularis_oris_L", "orbicularis_oris_R", "levator_labii_sup_L"})
        muscles.push_back(longMuscle(name));
    return muscles;
}

/// Every triangle in four.
TriangleMesh subdivided(const TriangleMesh& mesh) {
    TriangleMesh fine{mesh.vertices, {}};
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [place, added] =
            middles.try_emplace(std::minmax(a, b), static_cast<int>(fine.vertices.size()));
        if (added) fine.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
        return place->second;
    };
    for (const Tri& t : mesh.triangles) {
        const int x = middle(t[0], t[1]), y = middle(t[1], t[2]), z = middle(t[2], t[0]);
        fine.triangles.emplace_back(t[0], x, z);
        fine.triangles.emplace_back(x, t[1], y);
        fine.triangles.emplace_back(z, y, t[2]);
        fine.triangles.emplace_back(x, y, z);
    }
    return fine;
}

/// A skin over all facial muscles, and its table.
skins::Couple faceCouple(const TriangleMesh& skin) {
    skins::Couple couple{skin, {}, {}};
    std::vector<SkinSearchMuscle> searched;
    for (Muscle& m : allMuscles()) {
        couple.muscles.push_back(std::make_shared<const MuscleDeformer>(m));
        searched.push_back({couple.muscles.back().get(), skins::insetSpheres(m.surface, 1.5 * mm)});
    }
    SkinSearchOptions options;
    options.thickness = options.travel = 2 * skinThickness(skin);
    couple.table = searchSkin(skin, searched, options);
    return couple;
}

double cpuSeconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void print(const char* what, const skins::Depths& d) {
    std::cout << "  " << what << ": " << d.count << " vertices, 95 % within " << d.p95 / mm << " mm, worst "
              << d.worst / mm << " mm\n";
}

} // namespace

TEST_CASE("the frontal mask slides under the skin of the dog's head and the skin follows") {
    REQUIRE_SHARED_MESHES();
    Muscle mask = frontalMask();
    mask.maxContraction = 0.04;
    skins::Couple couple{dogMesh("skin_head"), {std::make_shared<const MuscleDeformer>(mask)}, {}};
    const MuscleDeformer& muscle = *couple.muscles[0];
    SkinSearchOptions options;
    options.thickness = options.travel = skinThickness(couple.skin);
    couple.table = searchSkin(couple.skin, {{&muscle, skins::insetSpheres(mask.surface, 1.5 * mm)}}, options);
    const Table& table = couple.table.table;
    std::cout << "dog face, frontal mask: skin " << table.record.spheresA << " -> " << table.a.size()
              << " spheres, muscle " << table.record.spheresB << " -> " << table.b.size() << ", "
              << table.testCount() << " tests a step (the paper's couple: 1426 -> 70, 280 -> 190, 268)\n";
    const std::vector<double> inRest = depths(couple.skin.vertices, mask.surface);
    const std::vector<double> outRest = skins::poking(mask.surface.vertices, couple.skin, 10 * mm);

    SkinResponse skin(couple.rig());
    compare::PushedSkin spheres(couple.skin, couple.table, couple.muscles);
    constexpr int frames = 60;
    double farthestOff = 0;
    const double volumeBelow = auditMesh(mask.surface).signedVolume;
    for (int f = 1; f <= frames; ++f) {
        const std::vector<double> a{static_cast<double>(f) / frames};
        skin.update(a);
        spheres.update(a);
        if (f % 20 != 0) continue;
        SkinResponse converged(couple.rig());
        for (int k = 0; k < 200; ++k) converged.update(a);
        const TriangleMesh solid{muscle.vertices(a[0]), mask.surface.triangles};
        double slide = 0;
        for (std::size_t v = 0; v < solid.vertices.size(); ++v)
            slide = std::max(slide, (solid.vertices[v] - mask.surface.vertices[v]).norm());
        const skins::Depths in = skins::beyond(depths(places(couple, skin), solid), inRest);
        const skins::Depths out = skins::beyond(
            skins::poking(solid.vertices, {places(couple, skin), couple.skin.triangles}, 10 * mm), outRest);
        const skins::Depths alone = skins::beyond(depths(spheres.places(), solid), inRest);
        const skins::Strain strain = skins::strain(skin);
        const double off = distance(skin, converged) / largestMove(converged);
        std::cout << " slide " << slide / mm << " mm, skin moves " << largestMove(skin) / mm
                  << " mm, from converged " << 100 * off << " %, edges " << strain.shortest << " to "
                  << strain.longest << ", flipped " << strain.flipped << ", area " << 100 * strain.area
                  << " %, volume below it " << strain.volume / (mm * mm * mm) << " mm^3 (muscle "
                  << volumeBelow / (mm * mm * mm) << ")\n";
        print("skin in muscle", in);
        print("muscle through skin", out);
        print("skin in muscle, spheres alone [paper]", alone);
        CHECK(largestMove(skin) > 0.8 * slide); // the tissue between the two hands on what the muscle does
        farthestOff = std::max(farthestOff, distance(skin, converged));
        CHECK(in.worst < 0.02 * mm);
        CHECK(out.worst < 0.02 * mm);
        CHECK(strain.shortest > 0.6);
        CHECK(strain.longest < 1.6);
        CHECK(strain.flipped == 0);
    }
    CHECK(farthestOff < 0.01 * largestMove(skin)); // of the largest displacement along the ramp
    CHECK(skin.update(std::vector<double>{0}).rest);
    CHECK(places(couple, skin) == couple.skin.vertices);
}

TEST_CASE("a facial muscle of the dog that tightens slowly never makes the skin jump") {
    REQUIRE_SHARED_MESHES();
    const skins::Couple couple = faceCouple(dogMesh("skin_head"));
    constexpr int steps = 125;
    std::size_t far = 0, all = 0;
    const std::shared_ptr<const SkinRig> rig = couple.rig();
    for (std::size_t m = 0; m < couple.muscles.size(); ++m) {
        SkinResponse skin(rig);
        std::vector<double> a(couple.muscles.size());
        std::vector<Vec3> before = rig->rest;
        std::vector<double> jumps;
        for (int s = 1; s <= steps; ++s) {
            a[m] = static_cast<double>(s) / steps;
            skin.update(a);
            double largest = 0;
            for (std::size_t v = 0; v < before.size(); ++v)
                largest = std::max(largest, (skin.positions()[v] - before[v]).norm());
            before.assign(skin.positions().begin(), skin.positions().end());
            jumps.push_back(largest);
        }
        std::sort(jumps.begin(), jumps.end());
        const double usual = jumps[steps / 2];
        const auto jumped =
            static_cast<std::size_t>(jumps.end() - std::upper_bound(jumps.begin(), jumps.end(), 5 * usual));
        std::cout << " muscle " << m << ": skin moves " << largestMove(skin) / mm << " mm, usually by "
                  << usual / mm << " mm a step, " << jumped << " of " << steps
                  << " steps by more than five times that, the largest " << jumps.back() / mm << " mm\n";
        far += jumped;
        all += jumps.size();
    }
    std::cout << " in all " << far << " of " << all << " steps\n";
    CHECK(far == 0);
}

TEST_CASE("all facial muscles of the dog move one skin of 29,000 vertices", "[.long]") {
    REQUIRE_SHARED_MESHES();
    const TriangleMesh skinMesh = subdivided(dogMesh("skin_head"));
    const skins::Couple couple = faceCouple(skinMesh);
    double start = cpuSeconds();
    SkinResponse skin(couple.rig());
    const double loading = cpuSeconds() - start;
    std::size_t active = 0;
    for (std::size_t v = 0; v < skin.rig().vertices.size(); ++v) active += !skin.rig().pulls[v].empty();
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> phase(0, 6.28);
    std::vector<double> phases, a(couple.muscles.size());
    for (std::size_t m = 0; m < a.size(); ++m) phases.push_back(phase(random));
    constexpr int frames = 120;
    start = cpuSeconds();
    skins::Strain worst;
    double measuring = 0;
    for (int f = 0; f < frames; ++f) {
        for (std::size_t m = 0; m < a.size(); ++m) a[m] = 0.5 - 0.5 * std::cos(0.1 * f + phases[m]);
        skin.update(a);
        const double now = cpuSeconds();
        const skins::Strain strain = skins::strain(skin);
        worst.shortest = std::min(worst.shortest, strain.shortest);
        worst.longest = std::max(worst.longest, strain.longest);
        worst.flipped = std::max(worst.flipped, strain.flipped);
        measuring += cpuSeconds() - now;
    }
    const double frame = (cpuSeconds() - start - measuring) / frames;
    std::cout << "dog face, " << a.size() << " muscles, " << skinMesh.vertices.size() << " skin vertices, "
              << active << " active, " << skin.rig().rows.size() << " rows, "
              << 1e-6 * static_cast<double>(skin.rig().bytes()) << " MB: " << 1e3 * frame << " ms a frame ("
              << 1 / frame << " frames/s), made in " << loading << " s; edges " << worst.shortest << " to "
              << worst.longest << ", flipped at most " << worst.flipped << '\n';
    CHECK(largestMove(skin) > 1 * mm);
    CHECK(largestMove(skin) < 20 * mm);
    CHECK(worst.shortest > 0.6); // 0.48 with rounds of contact that lower nothing
    CHECK(worst.longest < 1.6);
    CHECK(worst.flipped == 0);
    CHECK(skin.update({}).rest);
    CHECK(places(couple, skin) == skinMesh.vertices);
}
