#pragma once
#include "bake/table/PreparedTable.h"

namespace tss {

enum class BenchWith { Hit, Gap, Contact, Features, Pose };

/// "hit", "gap", "contact", "features", "pose"; false for another word.
bool benchWith(std::string_view name, BenchWith& with);

struct BenchResult {
    double nanoseconds = 0;        ///< a query, over all of them
    double featureNanoseconds = 0; ///< the features of a pose, made beforehand
    std::uint64_t hits = 0;
    double checksum = 0; ///< of all answers, so that none is left out by the compiler
};

/// Times `queries` queries alone. Their features are those of a fixed number of poses spread over the limits,
/// made beforehand and taken in turn: the same work whatever the number of queries, so that the instructions
/// of two runs (callgrind) differ by the queries alone. Contact: point,
/// normal and gradient too. Features: these alone, no query. Pose: a hit asked from the values of the pose,
/// everything that it takes included.
BenchResult benchQueries(const PreparedTable& table, const Motion& motion, std::uint64_t queries,
                         BenchWith with);

} // namespace tss
