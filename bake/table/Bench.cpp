#include "bake/table/Bench.h"
#include "bake/motion/MotionFrame.h"
#include "bake/table/Contact.h"
#include "bake/table/TablePairs.h"

#include <algorithm>
#include <chrono>

namespace tss {

namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::time_point from, Clock::time_point to, double count) {
    return count > 0 ? std::chrono::duration<double, std::nano>(to - from).count() / count : 0;
}

/// Calls query(i) for the poses in turn, pass after pass.
template <class Query>
void repeat(std::uint64_t queries, std::size_t poses, Query query) {
    while (queries > 0) {
        const std::size_t pass = std::min<std::uint64_t>(queries, poses);
        for (std::size_t i = 0; i < pass; ++i) query(i);
        queries -= pass;
    }
}

} // namespace

bool benchWith(std::string_view name, BenchWith& with) {
    if (name == "hit") return with = BenchWith::Hit, true;
    if (name == "gap") return with = BenchWith::Gap, true;
    if (name == "contact") return with = BenchWith::Contact, true;
    if (name == "features") return with = BenchWith::Features, true;
    if (name == "pose") return with = BenchWith::Pose, true;
    return false;
}

BenchResult benchQueries(const PreparedTable& table, const Motion& motion, std::uint64_t queries,
                         BenchWith with) {
    constexpr int poseCount = 512;
    const std::vector<std::vector<double>> poses = latticePoses(motion, poseCount);
    std::vector<TableFeatures> features(poses.size());
    std::vector<MotionFrame> frames(poses.size());
    const auto begin = Clock::now();
    for (std::size_t i = 0; i < poses.size(); ++i) table.features(poses[i].data(), features[i]);
    const auto made = Clock::now();
    for (std::size_t i = 0; i < poses.size(); ++i) table.frame(poses[i].data(), frames[i]);

    BenchResult result;
    TableContact c;
    const auto start = Clock::now();
    switch (with) {
    case BenchWith::Hit:
        repeat(queries, poses.size(), [&](std::size_t i) { result.hits += table.hit(features[i]); });
        break;
    case BenchWith::Gap:
        repeat(queries, poses.size(), [&](std::size_t i) {
            const TableGap g = table.gap(features[i]);
            result.hits += g.gap <= 0;
            result.checksum += g.gap;
        });
        break;
    case BenchWith::Contact:
        repeat(queries, poses.size(), [&](std::size_t i) {
            table.contact(features[i], frames[i], c);
            result.hits += c.gap <= 0;
            result.checksum += c.gap + c.point.x() + c.normal.x() + c.gradient[0];
        });
        break;
    case BenchWith::Features:
        repeat(queries, poses.size(), [&](std::size_t i) { table.features(poses[i].data(), features[i]); });
        break;
    case BenchWith::Pose:
        repeat(queries, poses.size(), [&](std::size_t i) { result.hits += table.hit(poses[i].data()); });
        break;
    }
    result.nanoseconds = nanoseconds(start, Clock::now(), static_cast<double>(queries));
    result.featureNanoseconds = nanoseconds(begin, made, static_cast<double>(poses.size()));
    return result;
}

} // namespace tss
