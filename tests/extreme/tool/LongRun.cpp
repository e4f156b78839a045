#include "tests/extreme/tool/LongRun.h"

#include "bake/play/SkinSetup.h"
#include "bake/respond/JointResponder.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <unistd.h>

namespace extreme {

namespace {

using namespace tss;

long residentBytes() {
    long pages = 0, resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
        std::fclose(file);
    }
    return resident * sysconf(_SC_PAGESIZE);
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

double farthest(std::span<const Vec3> x, const std::vector<Vec3>& y) {
    double most = 0;
    for (std::size_t k = 0; k < x.size(); ++k) most = std::max(most, (x[k] - y[k]).norm());
    return most;
}

} // namespace

ToAndFro driveToAndFro(const SceneModel& scene, long steps) {
    constexpr int round = 48;
    const Table& table = *scene.pairs.front().table;
    const JointResponder responder(table);
    JointWorkspace workspace = responder.workspace();
    const std::vector<Dof>& dofs = table.motion.dofs;
    std::vector<double> q = restValues(table.motion), asked(dofs.size());
    std::vector<std::vector<double>> second(round);
    ToAndFro result;
    result.deepest = std::numeric_limits<double>::infinity();
    for (; result.steps < steps; ++result.steps) {
        const int at = static_cast<int>(result.steps % round);
        const double share = (at < round / 2 ? at : round - at) / (round / 2.0);
        for (std::size_t k = 0; k < dofs.size(); ++k)
            asked[k] = dofs[k].lower + share * (dofs[k].upper - dofs[k].lower);
        const JointAnswer answer = responder.respond(q.data(), asked.data(), workspace);
        for (std::size_t k = 0; k < q.size(); ++k) q[k] = answer.q[k];
        result.blocked += answer.status != JointStatus::Free;
        result.deepest = std::min(result.deepest, answer.gap);
        if (result.steps < round) continue;
        if (result.steps < 2 * round) {
            second[at] = q;
            continue;
        }
        for (std::size_t k = 0; k < q.size(); ++k)
            result.drift = std::max(result.drift, std::abs(q[k] - second[at][k]));
    }
    return result;
}

ManyFrames playFrames(const SceneModel& scene, long frames, bool rest) {
    constexpr int round = 50;
    const SkinModel& skin = scene.skins.front();
    SkinResponse response(skinRig(scene, skin));
    ManyFrames result;
    result.size = response.rig().size;
    std::vector<std::vector<Vec3>> third(round);
    std::vector<double> times;
    long resident = 0;
    std::vector<double> activations(skin.muscles.size());
    for (long first = 0; first + round <= frames; first += round) {
        const bool last = first + 2 * round > frames;
        const std::clock_t start = std::clock(); // of the processor: other programs do not count
        for (int at = 0; at < round; ++at) {
            const double share = (at < round / 2 ? at : round - at) / (round / 2.0);
            activations.assign(activations.size(), rest ? share : 0.1 + 0.8 * share);
            response.update(activations);
            if (first == 2 * round)
                third[at].assign(response.positions().begin(), response.positions().end());
            if (last) result.creep = std::max(result.creep, farthest(response.positions(), third[at]));
            ++result.frames;
        }
        times.push_back(double(std::clock() - start));
        if (first == 2 * round) resident = residentBytes();
    }
    // A thousand frames each; the very first rounds warm the caches.
    const std::size_t part = std::min<std::size_t>(1000 / round, times.size() / 3);
    const auto early = times.begin() + std::min<std::size_t>(part, times.size() / 3);
    result.slowdown = median({times.end() - part, times.end()}) / median({early, early + part});
    result.growth = residentBytes() - resident;
    std::size_t subnormal = 0;
    for (const auto& list : {response.positions(), response.normals()})
        for (const Vec3& v : list)
            for (int k = 0; k < 3; ++k) subnormal += std::fpclassify(v[k]) == FP_SUBNORMAL;
    result.subnormals = double(subnormal) / (6. * double(response.positions().size()));
    return result;
}

} // namespace extreme
