#pragma once
#include "bake/respond/JointResponse.h"

#include <memory>
#include <span>
#include <vector>

namespace osgTSS {

/// A pair of bodies as the resolver sees it: its table, and where the table's DOFs stand among all values.
struct ResolverPair {
    std::shared_ptr<const tss::Table> table;
    std::vector<std::size_t> slots; ///< one a DOF of the table, indices into the values of all joints
};

/// Takes the values of several joints from `last` towards `q` so that no pair collides, and leaves in q what
/// was reached. Pairs may share joints: each is asked in turn, in order, until none changes anything any
/// more; where they do not agree after some rounds everything stays at `last`. Returns what each pair said
/// last.
std::vector<tss::JointResult> resolveJoints(std::span<const ResolverPair> pairs, std::span<const double> last,
                                            std::vector<double>& q);

} // namespace osgTSS
