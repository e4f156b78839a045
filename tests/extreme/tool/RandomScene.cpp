#include "tests/extreme/tool/RandomScene.h"

#include "bake/base/Error.h"
#include "tests/Shapes.h"
#include "tests/extreme/scenes/Builders.h"
#include "tests/respond/SkinShapes.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>

namespace extreme {

namespace {

using scenes::Random;

double logUniform(Random& random, double lower, double upper) {
    return lower * std::pow(upper / lower, random.in(0, 1));
}

/// About `size` across, around the origin.
TriangleMesh randomMesh(Random& random, double size) {
    const int kind = random.below(6);
    if (kind == 0) {
        const Vec3 half(logUniform(random, 1e-3, 0.5), logUniform(random, 1e-2, 0.5), 0.5);
        return boxMesh(-size * half, size * half);
    }
    if (kind == 1) { // a soup
        TriangleMesh mesh;
        for (int k = 3 + random.below(20); k > 0; --k) {
            const int first = static_cast<int>(mesh.vertices.size());
            const Vec3 at = random.inBox(0.4 * size);
            for (int corner = 0; corner < 3; ++corner)
                mesh.vertices.push_back(at + random.inBox(size * logUniform(random, 1e-4, 0.2)));
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        return mesh;
    }
    if (kind == 2) // balls of very different sizes
        return joined(roughBall(random.inBox(0.1 * size), 0.4 * size, 1),
                      roughBall(0.45 * size * random.direction(), size * logUniform(random, 1e-6, 0.05), 1));
    TriangleMesh ball = roughBall(Vec3::Zero(), 0.5 * size, 1 + random.below(2), random.in(0, 0.3));
    const Vec3 flat(1, logUniform(random, 1e-4, 1), logUniform(random, 1e-2, 1));
    for (Vec3& v : ball.vertices) v = v.cwiseProduct(flat);
    return ball;
}

void damage(Random& random, TriangleMesh& mesh) {
    const auto any = [&] { return mesh.triangles[std::size_t(random.below(int(mesh.triangles.size())))]; };
    for (int k = random.below(4); k > 0; --k) {
        const Tri t = any();
        switch (random.below(6)) {
        case 0:
            mesh.triangles.push_back(t);
            break;
        case 1:
            mesh.triangles.emplace_back(t[0], t[0], t[1]);
            break;
        case 2:
            if (mesh.triangles.size() > 1) mesh.triangles.erase(mesh.triangles.begin());
            break;
        case 3:
            std::swap(mesh.triangles.front()[0], mesh.triangles.front()[1]);
            break;
        case 4:
            mesh.triangles.emplace_back(t[0], t[1], any()[2]);
            break;
        default:
            mesh.vertices[std::size_t(t[0])] = mesh.vertices[std::size_t(t[1])];
        }
    }
}

Dof randomDof(Random& random, double size, const Vec3& about) {
    switch (random.below(5)) {
    case 0:
    case 1: {
        const double width = random.below(4) == 0 ? 360 : logUniform(random, 1e-6, 180);
        const double lower = random.below(4) == 0 ? 0 : -width * random.in(0, 1);
        const double lever = random.below(4) == 0 ? logUniform(random, 1, 1e5) : random.in(0, 2);
        return turn(about + lever * size * random.direction(), random.direction(), lower,
                    random.below(12) == 0 ? lower : lower + width);
    }
    case 2: {
        Dof dof =
            scenes::path(random, 2 + random.below(4), size * logUniform(random, 1e-3, 1), random.in(0, 3));
        dof.frame.translation() = about;
        return dof;
    }
    default: {
        const double length = size * (random.below(6) == 0 ? logUniform(random, 1, 1e5) : random.in(0, 3));
        const double scale = random.below(3) == 0 ? logUniform(random, 1e-4, 1e4) : 1;
        const double lower = -random.in(0, 1) * length / scale;
        return slide(scale * random.direction(), lower,
                     random.below(12) == 0 ? lower : lower + length / scale);
    }
    }
}

tss::BakeSettings randomSettings(Random& random, double size) {
    tss::BakeSettings settings{{"max-spheres", "2000"}, {"budget", "2"}};
    settings["tolerance"] = fmt::format("{}", size * logUniform(random, 2e-3, 0.2));
    const char* rest[] = {"offset", "ignore", "collide", "collide"};
    settings.emplace("at-rest", rest[random.below(4)]);
    if (random.below(4) == 0) settings["depth"] = fmt::format("{}", size * logUniform(random, 1e-4, 0.2));
    if (random.below(4) == 0) settings["epsilon"] = fmt::format("{}", size * logUniform(random, 1e-6, 0.05));
    if (random.below(8) == 0) settings.emplace("conservative", "false");
    if (random.below(8) == 0) settings.emplace("keep-spheres", "true");
    if (random.below(8) == 0) settings.emplace("reduce", "none");
    return settings;
}

/// Moves B so that at some pose within the limits a vertex of it lies on one of A.
void bringToMeet(Random& random, const TriangleMesh& a, TriangleMesh& b, const Motion& motion) {
    std::vector<double> q;
    for (const Dof& dof : motion.dofs) q.push_back(dof.lower + random.in(0, 1) * (dof.upper - dof.lower));
    const auto any = [&](const TriangleMesh& mesh) {
        const Tri& t = mesh.triangles[std::size_t(random.below(int(mesh.triangles.size())))];
        return mesh.vertices[std::size_t(t[random.below(3)])];
    };
    const Vec3 onA = any(a), onB = any(b), way = pose(motion, q).inverse(Eigen::Isometry) * onA - onB;
    for (Vec3& v : b.vertices) v += way;
}

/// meeting: draws where they meet, after all else; none: as it comes, which is mostly nowhere.
SceneModel randomPair(Random& random, Random* meeting) {
    const double size = logUniform(random, 1e-6, 1e6);
    const double sizeB = size * (random.below(3) == 0 ? logUniform(random, 1e-3, 1) : random.in(0.3, 1));
    const bool far = random.below(4) == 0;
    const Vec3 about = far ? Vec3(logUniform(random, 1, 1e7) * size * random.direction()) : Vec3::Zero();
    TriangleMesh a = randomMesh(random, size), b = randomMesh(random, sizeB);
    if (random.below(3) == 0) damage(random, a);
    if (random.below(3) == 0) damage(random, b);
    const Vec3 apart = random.in(0, 1.5) * size * random.direction();
    for (Vec3& v : a.vertices) v += about;
    for (Vec3& v : b.vertices) v += about + apart;
    Motion motion;
    for (int k = random.below(4); k > 0; --k) {
        motion.dofs.push_back(randomDof(random, size, about));
        motion.dofs.back().name = fmt::format("dof{}", k);
        Dof& dof = motion.dofs.back();
        dof.rest = random.below(2) ? dof.lower : dof.lower + random.in(0, 1) * (dof.upper - dof.lower);
    }
    if (meeting) bringToMeet(*meeting, a, b, motion);
    SceneModel scene = pairScene(a, b, motion, 0);
    const double units[] = {1e-6, 1e-3, 1, 1, 1e3, 1e6};
    scene.metersPerUnit = units[random.below(6)];
    if (random.below(4) == 0)
        for (tss::Body& body : scene.bodies)
            body.placement =
                tss::Pose(Eigen::Translation3d(1e7 * size * random.direction())) * body.placement;
    scene.pairs[0].settings = randomSettings(random, std::min(size, sizeB));
    return scene;
}

SceneModel randomSkin(Random& random) {
    const double unit = logUniform(random, 1e-6, 1e6);
    tss::MuscleModel muscle;
    muscle.path = "/Scene/Muscle";
    muscle.muscle = skins::muscleBelow(random.in(-0.05, 0.1), random.in(0, 0.5), random.in(-0.3, 0.3));
    muscle.muscle.form = random.below(2) ? tss::MuscleForm::Sheet : tss::MuscleForm::Tube;
    muscle.muscle.anchor = random.in(0, 1);
    if (random.below(4) == 0) muscle.muscle.activationLower = -random.in(0, 1);
    SceneModel scene;
    scene.defaultPrim = "Scene";
    scene.timeCodesPerSecond = logUniform(random, 0.1, 1e6);
    for (int t = 0; t < 12; ++t) {
        muscle.activation.times.push_back(t);
        muscle.activation.values.push_back(random.below(3) == 0 ? 0 : random.in(-0.5, 1.5));
    }
    scene.endTimeCode = 11;
    for (Vec3& v : muscle.muscle.surface.vertices) v *= unit;
    for (Vec3& v : muscle.muscle.fibre) v = (unit * v).cast<float>().cast<double>();
    muscle.muscle.surface = inFloat(muscle.muscle.surface);
    muscle.body = 0;
    tss::Body surface, sheet;
    surface.path = "/Scene/Surface";
    surface.mesh = muscle.muscle.surface;
    sheet.path = "/Scene/Skin";
    sheet.mesh = skins::vaultedSheet(2 * (1 + random.below(8)), 1, random.in(-0.05, 0.1), random.in(0, 0.6));
    for (Vec3& v : sheet.mesh.vertices) v *= unit;
    sheet.mesh = inFloat(sheet.mesh);
    scene.bodies = {surface, sheet};
    scene.muscles = {muscle};
    tss::SkinModel skin;
    skin.path = sheet.path;
    skin.body = 1;
    skin.muscles = {0};
    if (random.below(2)) skin.thickness = unit * logUniform(random, 1e-4, 0.2);
    if (random.below(2)) skin.travel = unit * logUniform(random, 1e-4, 0.2);
    const auto compliance = [&] { return random.below(3) == 0 ? 0 : logUniform(random, 1e-12, 1e12); };
    skin.stretchCompliance = compliance();
    skin.bendCompliance = compliance();
    if (random.below(2))
        for (std::size_t v = 0; v < sheet.mesh.vertices.size(); ++v) {
            skin.tether.push_back(random.below(2) ? 0 : random.in(0, 1));
            skin.attach.push_back(random.below(2) ? 0 : random.in(0, 1));
        }
    skin.selfContact = random.below(3) == 0;
    scene.skins = {skin};
    return scene;
}

} // namespace

std::string randomScene(std::uint64_t seed, Bodies bodies) {
    Random random(seed * 0x9E3779B97F4A7C15u + 1), meeting(seed);
    if (random.below(8) == 0) return textOf(randomSkin(random));
    return textOf(randomPair(random, bodies == Bodies::Meet ? &meeting : nullptr));
}

RandomRun runRandom(std::uint64_t seed, double budget, Bodies bodies) {
    // Of the processor, so that a busy machine finds what an idle one does.
    const std::clock_t start = std::clock();
    const auto seconds = [&] { return double(std::clock() - start) / CLOCKS_PER_SEC; };
    RandomRun run;
    run.seed = seed;
    ServeOptions options;
    options.poses = 40;
    options.steps = 40;
    options.seed = seed;
    options.progress = [&](std::string_view, double) {
        run.stopped = run.stopped || seconds() > budget;
        return !run.stopped;
    };
    try {
        const Outcome outcome = serve(randomScene(seed, bodies), fmt::format("seed{}", seed), options);
        run.refusal = outcome.refusal;
        run.troubles = outcome.troubles;
        for (const tss::Pair& pair : outcome.scene.pairs) run.table = run.table || pair.table;
        if (!run.stopped && !run.refusal.empty() && run.refusal.find('<') == std::string::npos)
            run.troubles.push_back(fmt::format("refused without a prim path: {}", run.refusal));
    } catch (const tss::InputError& error) { // what cannot be spelled as a file
        run.refusal = error.what();
    } catch (const std::exception& error) {
        run.troubles.push_back(fmt::format("threw {}", error.what()));
    }
    run.seconds = seconds();
    return run;
}

} // namespace extreme
