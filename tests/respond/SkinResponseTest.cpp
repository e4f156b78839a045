#include "SkinMeasure.h"
#include "SkinShapes.h"
#include "tests/FloatTraps.h"

#include "bake/base/Error.h"
#include "bake/compare/PushedSkin.h"
#include "bake/respond/SkinCosts.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using skins::exactlyAtRest, skins::largestMove, skins::run;

TEST_CASE("a contracting muscle lifts the skin above it") {
    SkinResponse response(skins::usual().rig());
    for (int f = 1; f <= 40; ++f) {
        const SkinUpdate update = response.update(std::vector<double>{f / 40.0});
        CHECK(update.moved);
    }
    run(response, 1, 50);
    double lift = 0;
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        lift = std::max(lift, response.positions()[i].z() - response.rig().rest[i].z());
    CHECK(lift > 0.01);
    CHECK(lift < 0.1);
}

TEST_CASE("a skin that is wound inwards is lifted as one that is not, its normals the other way") {
    const skins::Couple outward = skins::usual();
    TriangleMesh turned = outward.skin;
    for (Tri& t : turned.triangles) std::swap(t[1], t[2]);
    const skins::Couple inward = skins::couple(turned, {skins::muscleBelow(0)});
    SkinParameters loose; // so that contacts alone lift it
    loose.attach.assign(turned.vertices.size(), 0);
    SkinResponse one(outward.rig(loose)), other(inward.rig(loose));
    for (SkinResponse* response : {&one, &other})
        CHECK(response->update(std::vector<double>{1}).contacts > 0);
    REQUIRE(one.vertices().size() == other.vertices().size());
    double off = 0, turn = 0;
    for (std::size_t i = 0; i < one.vertices().size(); ++i) {
        REQUIRE(one.vertices()[i] == other.vertices()[i]);
        off = std::max(off, (one.positions()[i] - other.positions()[i]).norm());
        turn = std::max(turn, (one.normals()[i] + other.normals()[i]).norm());
    }
    CHECK(off < 1e-5);
    CHECK(turn < 1e-3);
    other.update(std::vector<double>{0});
    CHECK(exactlyAtRest(other));
    CHECK(other.normals()[0].z() < 0);
}

TEST_CASE("skin whose triangles share no vertex is lifted as one") {
    const skins::Couple whole = skins::usual();
    TriangleMesh split;
    for (const Tri& t : whole.skin.triangles) {
        const auto first = static_cast<int>(split.vertices.size());
        for (int k = 0; k < 3; ++k) split.vertices.push_back(whole.skin.vertices[t[k]]);
        split.triangles.emplace_back(first, first + 1, first + 2);
    }
    const skins::Couple parts = skins::couple(split, {skins::muscleBelow(0)});
    SkinParameters loose; // so that contacts alone lift it
    loose.attach.assign(whole.skin.vertices.size(), 0);
    SkinResponse one(whole.rig(loose));
    loose.attach.assign(split.vertices.size(), 0);
    SkinResponse many(parts.rig(loose));
    for (SkinResponse* response : {&one, &many}) CHECK(response->update(std::vector<double>{1}).contacts > 0);
    std::vector<Vec3> now = whole.skin.vertices;
    for (std::size_t i = 0; i < one.vertices().size(); ++i) now[one.vertices()[i]] = one.positions()[i];
    std::vector<Vec3> places = split.vertices;
    for (std::size_t i = 0; i < many.vertices().size(); ++i) places[many.vertices()[i]] = many.positions()[i];
    double off = 0;
    for (std::size_t i = 0; i < split.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            off = std::max(off, (places[split.triangles[i][k]] - now[whole.skin.triangles[i][k]]).norm());
    CHECK(off < 1e-3);
    many.update(std::vector<double>{0});
    CHECK(exactlyAtRest(many));
}

TEST_CASE(
    "what a muscle by itself has moved is not looked up, and what an update costs is told while asked") {
    SkinResponse response(skins::usual().rig());
    SkinCosts costs;
    response.charge(&costs);
    constexpr std::size_t frames = 40;
    for (std::size_t f = 1; f <= frames; ++f)
        response.update(std::vector<double>{static_cast<double>(f) / frames});
    CHECK(costs.updates == frames);
    CHECK(costs.lookUps == 0); // 1,640 where triangles but the first were compared with where they rest
    for (const SkinPart part : {SkinPart::Carry, SkinPart::Sort, SkinPart::Show})
        CHECK(costs.seconds[static_cast<std::size_t>(part)] > 0);
    for (const SkinPart part : {SkinPart::Bones, SkinPart::Folds})
        CHECK(costs.seconds[static_cast<std::size_t>(part)] == 0);
    response.charge(nullptr);
    response.update(std::vector<double>{0.5});
    CHECK(costs.updates == frames);
    CHECK(response.rig().rows.size() > 0);
}

TEST_CASE("skin keeps the distance to the muscle that it had at rest, up to its thickness") {
    const skins::Couple couple = skins::usual();
    SkinResponse response(couple.rig());
    for (int f = 1; f <= 60; ++f) response.update(std::vector<double>{f / 60.0});
    run(response, 1, 200);
    const MuscleDeformer& muscle = *couple.muscles[0];
    const TriangleMesh tight{muscle.vertices(1), muscle.muscle().surface.triangles};
    const ClosestPointQuery before(muscle.muscle().surface), after(tight);
    const auto height = [](const ClosestPointQuery& locator, const TriangleMesh& mesh, const Vec3& x) {
        const NearestPoint p = locator.nearest(x, 1e9);
        const Vec3 n = (mesh.corner(p.triangle, 1) - mesh.corner(p.triangle, 0))
                           .cross(mesh.corner(p.triangle, 2) - mesh.corner(p.triangle, 0));
        return (x - p.point).dot(n) < 0 ? -p.distance : p.distance;
    };
    for (const SkinRow& row : response.rig().rows) {
        const double kept =
            std::min(0.0, height(before, muscle.muscle().surface, response.rig().rest[row.vertex]));
        CHECK(height(after, tight, response.positions()[row.vertex]) > kept - 0.002);
    }
}

TEST_CASE("an update says how far contacts move the skin") {
    const skins::Couple couple = skins::usual();
    SkinParameters loose; // so that contacts alone lift it
    loose.attach.assign(couple.skin.vertices.size(), 0);
    SkinResponse response(couple.rig(loose));
    const SkinUpdate lifted = response.update(std::vector<double>{1});
    CHECK(lifted.pushed > 0.01);
    CHECK(lifted.pushed == Approx(largestMove(response)).margin(1e-5));
    CHECK(response.update(std::vector<double>{1}).pushed == lifted.pushed); // also where nothing is new
    CHECK(response.update(std::vector<double>{0}).pushed == 0);
}

TEST_CASE("a symmetric skin over a symmetric muscle moves symmetrically") {
    // Its quads are all split the same way; skin follows the triangles, so those of one half are mirrored.
    Muscle muscle = skins::muscleBelow(0);
    const std::vector<Vec3> places = muscle.surface.vertices;
    const auto mirrored = [&](int v) {
        const Vec3 image = places[v].cwiseProduct(Vec3(1, -1, 1));
        const auto found = std::find_if(places.begin(), places.end(),
                                        [&](const Vec3& x) { return (x - image).norm() < 1e-9; });
        REQUIRE(found != places.end());
        return static_cast<int>(found - places.begin());
    };
    std::vector<Tri> triangles;
    for (const Tri& t : muscle.surface.triangles) {
        if (places[t[0]].y() + places[t[1]].y() + places[t[2]].y() < 0) continue;
        triangles.push_back(t);
        triangles.emplace_back(mirrored(t[0]), mirrored(t[2]), mirrored(t[1]));
    }
    REQUIRE(triangles.size() == muscle.surface.triangles.size());
    muscle.surface.triangles = triangles;
    const skins::Couple couple = skins::couple(skins::vaultedSheet(32, 1, 0.01, 0.3), {muscle});
    SkinResponse response(couple.rig());
    run(response, 1, 1);
    const double most = largestMove(response);
    // Where each touched vertex's mirror image in y stands.
    const int n = 32;
    std::vector<int> indexOf(couple.skin.vertices.size(), -1);
    for (std::size_t i = 0; i < response.rig().vertices.size(); ++i)
        indexOf[response.rig().vertices[i]] = static_cast<int>(i);
    for (std::size_t i = 0; i < response.positions().size(); ++i) {
        const int v = static_cast<int>(response.rig().vertices[i]);
        const int mirror = indexOf[(n - v / (n + 1)) * (n + 1) + v % (n + 1)];
        REQUIRE(mirror >= 0);
        const Vec3 a = response.positions()[i];
        const Vec3 b = response.positions()[mirror].cwiseProduct(Vec3(1, -1, 1));
        CHECK((a - b).norm() < 1e-3 * most);
    }
}

TEST_CASE("the rim of a cut skin is not torn to rags: it bends along itself") {
    // The half above y = 0, its rim over the middle of the muscle and, as a cut mesh has it, unevenly spaced.
    constexpr int n = 32;
    TriangleMesh skin = skins::vaultedSheet(n, 1, 0.01, 0.3);
    std::erase_if(skin.triangles,
                  [](const Tri& t) { return *std::min_element(t.begin(), t.end()) < (n / 2) * (n + 1); });
    for (int i = 1; i < n; ++i) skin.vertices[n / 2 * (n + 1) + i].x() += (i % 3 - 1) * 0.4 * 2.0 / n;
    const skins::Couple couple = skins::couple(skin, {skins::muscleBelow(0)});
    SkinResponse response(couple.rig());
    for (int f = 1; f <= 60; ++f) response.update(std::vector<double>{f / 60.0});
    std::vector<Vec3> moves(skin.vertices.size(), Vec3::Zero());
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        moves[response.rig().vertices[i]] = response.positions()[i] - response.rig().rest[i];
    const auto roughness = [&](int row) {
        double sum = 0;
        for (int i = 1; i < n; ++i) {
            const int at = row * (n + 1) + i;
            const double before = (skin.vertices[at] - skin.vertices[at - 1]).norm(),
                         after = (skin.vertices[at + 1] - skin.vertices[at]).norm();
            sum += (moves[at] - (after * moves[at - 1] + before * moves[at + 1]) / (before + after))
                       .squaredNorm();
        }
        return std::sqrt(sum);
    };
    INFO("rim " << roughness(n / 2) << ", beside it " << roughness(n / 2 + 2));
    CHECK(roughness(n / 2 + 2) > 0);
    CHECK(roughness(n / 2) < 4 * roughness(n / 2 + 2));
}

TEST_CASE("activations outside the range are clamped, and what is no number counts as none") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    const skins::Couple couple = skins::usual();
    SkinResponse asked(couple.rig()), clamped(couple.rig());
    asked.update(std::vector<double>{1e9});
    clamped.update(std::vector<double>{1});
    CHECK(std::equal(asked.positions().begin(), asked.positions().end(), clamped.positions().begin()));
    CHECK(asked.update(std::vector<double>{std::nan("")}).rest);
    CHECK(asked.update({}).rest);
}

TEST_CASE("without the elastic sheet only skin of the table moves; with it the move dies away around") {
    const skins::Couple couple = skins::usual();
    compare::PushedSkin spheres(couple.skin, couple.table, couple.muscles);
    SkinResponse sheet(couple.rig());
    CHECK(spheres.update(std::vector<double>{1}));
    CHECK_FALSE(spheres.update(std::vector<double>{1}));
    run(sheet, 1, 100);
    std::vector<bool> inTable(couple.skin.vertices.size(), false);
    for (const std::uint32_t v : couple.table.skinVertices) inTable[v] = true;
    double largest = 0;
    for (std::size_t v = 0; v < inTable.size(); ++v) {
        largest = std::max(largest, (spheres.places()[v] - couple.skin.vertices[v]).norm());
        if (!inTable[v]) CHECK(spheres.places()[v] == couple.skin.vertices[v]);
    }
    CHECK(largest > 0.005);
    bool linked = false;
    for (std::size_t i = 0; i < sheet.positions().size(); ++i) {
        const double move = (sheet.positions()[i] - sheet.rig().rest[i]).norm();
        linked = linked || (!inTable[sheet.rig().vertices[i]] && move > 0.001);
    }
    CHECK(linked);
}

TEST_CASE("tethered skin stays where no contact pushes it") {
    const skins::Couple couple =
        skins::couple(skins::vaultedSheet(32, 1, 0.01, 0.3), {skins::muscleBelow(0.05)});
    SkinParameters parameters;
    SkinResponse freely(couple.rig(parameters));
    parameters.tether.assign(couple.skin.vertices.size(), 1);
    SkinResponse held(couple.rig(parameters));
    run(held, 0.1, 100);
    run(freely, 0.1, 100);
    CHECK(largestMove(freely) > 1e-3);
    CHECK(largestMove(held) < 0.01 * largestMove(freely));
}

TEST_CASE("a muscle that rides on a bone takes the skin along") {
    const skins::Couple couple = skins::usual();
    SkinParameters parameters;
    parameters.frames = {0};
    SkinResponse response(couple.rig(parameters));
    Pose pose = Pose::Identity();
    pose.translation() = Vec3(0, 0, 0.05);
    for (int f = 0; f < 100; ++f) response.update(std::vector<double>{0}, std::vector<Pose>{pose});
    double lift = 0;
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        lift = std::max(lift, response.positions()[i].z() - response.rig().rest[i].z());
    CHECK(lift == Approx(0.05).margin(0.01));
    CHECK(response.update(std::vector<double>{0}, std::vector<Pose>{Pose::Identity()}).rest);
    CHECK(exactlyAtRest(response));
}

TEST_CASE("a skin, its muscles and its table must fit each other") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    skins::Couple couple = skins::usual();
    SkinParameters parameters;
    SECTION("a vertex that is not there") {
        couple.table.skinVertices[0] = 1000000;
    }
    SECTION("a muscle that is not there") {
        couple.table.muscleOf[0] = 1;
    }
    SECTION("a sphere that is not there") {
        couple.table.table.columns[0] = 1000000;
    }
    SECTION("tethers of another skin") {
        parameters.tether = {0.5};
    }
    SECTION("a tether over 1") {
        parameters.tether.assign(couple.skin.vertices.size(), 1.5);
    }
    SECTION("a negative compliance") {
        parameters.stretchCompliance = -1;
    }
    SECTION("a compliance that is no number") {
        parameters.bendCompliance = std::nan("");
    }
    SECTION("no iterations") {
        parameters.iterations = 0;
    }
    CHECK_THROWS_AS(couple.rig(parameters), InputError);
}

TEST_CASE("a skin that no muscle reaches has nothing to do") {
    const skins::Couple couple = skins::couple(skins::vaultedSheet(8, 1, 5, 0.1), {skins::muscleBelow(0)});
    CHECK(couple.table.table.testCount() == 0);
    SkinResponse response(couple.rig());
    response.update(std::vector<double>{1});
    CHECK(response.positions().empty());
}
