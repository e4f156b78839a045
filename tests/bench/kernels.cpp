// The query kernels alone, by target, motion and size: features given, features made, and many at once.
#include "bake/motion/MotionFrame.h"
#include "bake/table/Contact.h"
#include "bake/table/PreparedTable.h"
#include "bake/table/TablePairs.h"
#include "tests/bench/JawLike.h"

#include <benchmark/benchmark.h>

using namespace tss;

namespace {

enum class Ask { Hit, Gap, Contact, Features, Crowd };

struct Poses {
    std::vector<std::vector<double>> values;
    std::vector<TableFeatures> features;
    std::vector<MotionFrame> frames;
};

Poses posesOf(const PreparedTable& table, const Motion& motion) {
    Poses poses;
    poses.values = latticePoses(motion, 512);
    poses.features.resize(512);
    poses.frames.resize(512);
    for (std::size_t i = 0; i < 512; ++i) {
        table.features(poses.values[i].data(), poses.features[i]);
        table.frame(poses.values[i].data(), poses.frames[i]);
    }
    return poses;
}

void one(benchmark::State& state, KernelTarget target, int dofs, std::size_t tests, Ask ask) {
    const Table table = jaw_like::table(dofs, tests, 0.1);
    const PreparedTable t(table, {target, {}, {}});
    const Poses poses = posesOf(t, table.motion);
    TableFeatures made;
    TableContact contact;
    std::size_t i = 0;
    for (auto _ : state) {
        switch (ask) {
        case Ask::Hit:
            benchmark::DoNotOptimize(t.hit(poses.features[i]));
            break;
        case Ask::Gap:
            benchmark::DoNotOptimize(t.gap(poses.features[i]));
            break;
        case Ask::Contact:
            t.contact(poses.features[i], poses.frames[i], contact);
            benchmark::DoNotOptimize(contact);
            break;
        default:
            t.features(poses.values[i].data(), made);
            benchmark::DoNotOptimize(made);
        }
        i = (i + 1) & 511;
    }
    state.SetLabel(std::string(name(t.form())) + " " + name(t.precision()));
}

/// 10,000 jaws of one table, features and verdicts of a frame.
void crowd(benchmark::State& state, KernelTarget target, int dofs, std::size_t tests) {
    constexpr std::uint32_t count = 10000;
    const Table table = jaw_like::table(dofs, tests, 0.1);
    const PreparedTable t(table, {target, {}, {}});
    std::vector<double> q;
    for (const std::vector<double>& values : latticePoses(table.motion, count))
        q.insert(q.end(), values.begin(), values.end());
    InstanceFeatures features;
    std::vector<std::uint8_t> hits(count);
    for (auto _ : state) {
        t.instanceFeatures(q.data(), count, features);
        t.hits(features, hits.data());
        benchmark::DoNotOptimize(hits.data());
        benchmark::ClobberMemory();
    }
}

void add(KernelTarget target, int dofs, std::size_t tests) {
    const std::string where =
        std::string(name(target)) + "/" + std::to_string(dofs) + " DOF/" + std::to_string(tests) + " pairs/";
    const std::pair<const char*, Ask> asks[] = {
        {"hit", Ask::Hit}, {"gap", Ask::Gap}, {"contact", Ask::Contact}, {"features", Ask::Features}};
    for (const auto& [what, ask] : asks)
        benchmark::RegisterBenchmark((where + what).c_str(),
                                     [=, ask = ask](auto& state) { one(state, target, dofs, tests, ask); });
    benchmark::RegisterBenchmark((where + "crowd of 10000").c_str(),
                                 [=](auto& state) { crowd(state, target, dofs, tests); });
}

} // namespace

int main(int argc, char** argv) {
    for (KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                KernelTarget::Avx512, KernelTarget::Neon})
        for (int dofs = 1; dofs <= 3 && available(target); ++dofs)
            for (std::size_t tests : {22, 268}) add(target, dofs, tests);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
