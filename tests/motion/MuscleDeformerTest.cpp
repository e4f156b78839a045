#include "bake/motion/MuscleDeformer.h"
#include "bake/base/Error.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/motion/MuscleVolume.h"
#include "tests/BentEllipsoid.h"
#include "tests/FloatTraps.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

Muscle bentMuscle(MuscleForm form, double height, double bend = 0.3) {
    test::BentEllipsoid shape;
    shape.bend = bend;
    shape.halfWidth = 0.3;
    shape.halfHeight = height;
    Muscle muscle = test::bentEllipsoid(shape);
    muscle.form = form;
    muscle.maxContraction = 0.3;
    muscle.activationLower = -0.5;
    return muscle;
}

double length(const std::vector<Vec3>& vertices, const Vec3& along) {
    double lower = 1e300, upper = -1e300;
    for (const Vec3& v : vertices) {
        lower = std::min(lower, v.dot(along));
        upper = std::max(upper, v.dot(along));
    }
    return upper - lower;
}

} // namespace

TEST_CASE("a bent ellipsoid has the volume of the straight one") {
    test::BentEllipsoid shape;
    shape.rings = shape.sectors = 128;
    shape.halfWidth = 0.2;
    shape.halfHeight = 0.1;
    const double exact = 4.0 / 3 * std::numbers::pi * 0.2 * 0.1;
    for (const double bend : {0.0, 0.5, -0.2}) {
        shape.bend = bend;
        const Muscle muscle = test::bentEllipsoid(shape);
        CHECK(enclosedVolume(muscle.surface.vertices, muscle.surface.triangles) ==
              Approx(exact).epsilon(2e-3));
    }
}

TEST_CASE("a muscle keeps its volume at every activation") {
    const auto form = GENERATE(MuscleForm::Tube, MuscleForm::Sheet);
    const MuscleDeformer muscle(bentMuscle(form, form == MuscleForm::Sheet ? 0.05 : 0.2));
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> activation(-0.5, 1);
    for (int i = 0; i < 50; ++i) {
        const double a = activation(random);
        const double volume = enclosedVolume(muscle.vertices(a), muscle.muscle().surface.triangles);
        INFO("seed 7, activation " << a);
        CHECK(volume == Approx(muscle.restVolume()).epsilon(1e-12));
        CHECK(muscle.state(a).thickening == Approx(1).epsilon(0.2));
    }
}

TEST_CASE("at activation 0 a muscle is its rest shape bit for bit") {
    const MuscleDeformer muscle(bentMuscle(MuscleForm::Sheet, 0.05));
    const std::vector<Vec3> vertices = muscle.vertices(0);
    for (std::size_t v = 0; v < vertices.size(); ++v)
        CHECK(vertices[v] == muscle.muscle().surface.vertices[v]);
    CHECK(muscle.map(Vec3(0.1, 0.2, 5), 0) == Vec3(0.1, 0.2, 5));
}

TEST_CASE("a muscle shortens by its contraction and thickens") {
    Muscle source = bentMuscle(MuscleForm::Tube, 0.2, 0);
    const MuscleDeformer muscle(source);
    const std::vector<Vec3> rest = muscle.vertices(0), tight = muscle.vertices(1),
                            loose = muscle.vertices(-0.5);
    CHECK(length(tight, Vec3::UnitX()) == Approx(0.7 * length(rest, Vec3::UnitX())).epsilon(1e-9));
    CHECK(length(loose, Vec3::UnitX()) == Approx(1.15 * length(rest, Vec3::UnitX())).epsilon(1e-9));
    CHECK(length(tight, Vec3::UnitZ()) > 1.1 * length(rest, Vec3::UnitZ()));
    CHECK(length(loose, Vec3::UnitZ()) < 0.97 * length(rest, Vec3::UnitZ()));
}

TEST_CASE("the anchor stays where it is") {
    for (const double anchor : {0.0, 0.35, 1.0}) {
        Muscle source = bentMuscle(MuscleForm::Tube, 0.2);
        source.anchor = anchor;
        const MuscleDeformer muscle(source);
        const Vec3 point = muscle.fibre().point(anchor);
        CHECK((muscle.map(point, 0.8) - point).norm() < 1e-12);
    }
}

TEST_CASE("a sheet thickens across, not along its width") {
    const MuscleDeformer muscle(bentMuscle(MuscleForm::Sheet, 0.03, 0));
    const std::vector<Vec3> rest = muscle.vertices(0), tight = muscle.vertices(1);
    CHECK(length(tight, Vec3::UnitZ()) > 1.2 * length(rest, Vec3::UnitZ()));
    CHECK(length(tight, Vec3::UnitY()) < 1.1 * length(rest, Vec3::UnitY()));
}

TEST_CASE("a sheet far thinner than its edges are long thickens in its middle and not at its rim") {
    test::BentEllipsoid shape;
    shape.halfWidth = 0.3;
    shape.halfHeight = 0.004;
    shape.rings = shape.sectors = 12;
    Muscle thin = test::bentEllipsoid(shape);
    thin.form = MuscleForm::Sheet;
    thin.maxContraction = 0.3;
    const MuscleDeformer muscle(std::move(thin));
    CHECK(muscle.state(1).thickening > 0.3);
    for (const MusclePoint& point : muscle.surfacePoints()) CHECK(point.offset.norm() < 2 * shape.halfHeight);
}

TEST_CASE("a point that the muscle carries moves with the surface below it") {
    const MuscleDeformer muscle(bentMuscle(MuscleForm::Tube, 0.2));
    const std::vector<Vec3> normals = vertexNormals(muscle.muscle().surface);
    const std::vector<Vec3>& rest = muscle.muscle().surface.vertices;
    const std::vector<Vec3> tight = muscle.vertices(1);
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const Vec3 above = rest[v] + 1e-6 * normals[v], below = rest[v] - 1e-6 * normals[v];
        CHECK((muscle.map(above, 1) - tight[v]).norm() < 1e-4);
        CHECK((muscle.map(below, 1) - tight[v]).norm() < 1e-4);
    }
}

namespace {

/// Without some triangles here and there, by which two openings touch at a vertex.
TriangleMesh pierced(TriangleMesh mesh) {
    std::vector<Tri> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (t % 97 > 2) kept.push_back(mesh.triangles[t]);
    mesh.triangles = kept;
    return mesh;
}

} // namespace

TEST_CASE("a muscle with small openings deforms as it does without") {
    const auto form = GENERATE(MuscleForm::Tube, MuscleForm::Sheet);
    Muscle muscle = bentMuscle(form, form == MuscleForm::Sheet ? 0.05 : 0.2);
    const MuscleDeformer whole(muscle);
    const Tri extra(0, 1, 2); // a flap, an edge of which three triangles have
    muscle.surface = pierced(std::move(muscle.surface));
    muscle.surface.triangles.push_back(extra);
    const MuscleDeformer open(muscle);
    CHECK(open.restVolume() == Approx(whole.restVolume()).epsilon(2e-3));
    CHECK(open.closedTriangles().size() > muscle.surface.triangles.size());
    CHECK(whole.closedTriangles().size() == whole.muscle().surface.triangles.size());
    CHECK(open.vertices(0) == whole.vertices(0));
    for (const double a : {-0.5, 0.4, 1.0}) {
        const std::vector<Vec3> now = open.vertices(a), wanted = whole.vertices(a);
        CHECK(enclosedVolume(now, open.closedTriangles()) == Approx(open.restVolume()).epsilon(1e-9));
        double off = 0;
        for (std::size_t v = 0; v < now.size(); ++v) off = std::max(off, (now[v] - wanted[v]).norm());
        CHECK(off < 2e-3);
    }
}

TEST_CASE("a track meets the exact deformation at its nodes and says how far it is off between them") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    const MuscleDeformer muscle(bentMuscle(MuscleForm::Tube, 0.2));
    const std::vector<double> nodes = activationNodes(-0.5, 1, 24);
    CHECK(std::count(nodes.begin(), nodes.end(), 0.0) == 1);
    const MuscleTrack track = makeTrack(muscle, muscle.surfacePoints(), nodes);
    CHECK(track.error > 0);
    CHECK(track.error < 2e-4);
    for (const double a : {-0.5, -0.31, 0.0, 0.013, 0.77, 1.0}) {
        const std::vector<Vec3> exact = muscle.vertices(a);
        const TrackPlace place = locate(nodes, a);
        for (std::size_t v = 0; v < exact.size(); ++v)
            CHECK((trackPosition(track, place, v) - exact[v]).norm() <= 1.1 * track.error);
    }
    CHECK(locate(nodes, 7).node == nodes.size() - 1);
    CHECK(trackPosition(track, locate(nodes, std::nan("")), 3) == muscle.muscle().surface.vertices[3]);
}

TEST_CASE("muscles that cannot be served are refused") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    Muscle muscle = bentMuscle(MuscleForm::Tube, 0.2);
    SECTION("open, a half of it") {
        std::erase_if(muscle.surface.triangles, [&](const Tri& t) {
            return muscle.surface.vertices[t[0]].z() > 0 && muscle.surface.vertices[t[1]].z() > 0;
        });
    }
    SECTION("open all round, one side of a sheet") {
        std::erase_if(muscle.surface.triangles, [&](const Tri& t) {
            const TriangleMesh& mesh = muscle.surface;
            return (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                       .z() < 0;
        });
    }
    SECTION("inside out") {
        for (Tri& t : muscle.surface.triangles) std::swap(t[0], t[1]);
    }
    SECTION("flat, as a surface from both sides") {
        muscle.surface.vertices = {{0, 0, 0}, {1, 0.1, 0.3}, {0.9, 1, 0.7}, {0.1, 1.1, 0.5}};
        muscle.surface.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
        const Eigen::Isometry3d away =
            Eigen::Translation3d(3, 2, 1) * Eigen::AngleAxisd(0.05, Vec3(1, 2, 3).normalized());
        for (Vec3& v : muscle.surface.vertices) v = away * v;
    }
    SECTION("a hair's breadth of volume") {
        for (Vec3& v : muscle.surface.vertices) v.z() *= 1e-12;
    }
    SECTION("of two shells, the smaller inside out") {
        const Muscle other = bentMuscle(MuscleForm::Tube, 0.2);
        const int first = static_cast<int>(muscle.surface.vertices.size());
        for (const Vec3& v : other.surface.vertices)
            muscle.surface.vertices.push_back(0.9 * v + Vec3(0, 0, 3));
        for (const Tri& t : other.surface.triangles)
            muscle.surface.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
    }
    SECTION("no fibre") {
        muscle.fibre.resize(1);
    }
    SECTION("a fibre of no length") {
        muscle.fibre = {Vec3::Zero(), Vec3::Ones(), Vec3::Zero()};
    }
    SECTION("a fibre with a point far away") {
        muscle.fibre[muscle.fibre.size() / 2].y() = 1e9;
    }
    SECTION("an insertion far away") {
        muscle.fibre.back().x() = -3e38;
    }
    SECTION("shortened to nothing") {
        muscle.maxContraction = 0.9;
    }
    SECTION("no activation range") {
        muscle.activationLower = 2;
    }
    SECTION("a vertex that is not a number") {
        muscle.surface.vertices[3][1] = std::nan("");
    }
    SECTION("an index out of range") {
        muscle.surface.triangles[0][2] = 100000;
    }
    CHECK_THROWS_AS(MuscleDeformer(std::move(muscle)), InputError);
}
