#pragma once
#include "bake/respond/JointModel.h"
#include "bake/respond/JointStatus.h"
#include "bake/table/Table.h"

namespace tss {

/// A resolved pose. Only the first dofCount values of q mean anything.
struct JointAnswer {
    JointValues q{};
    JointStatus status = JointStatus::Free;
    double gap = 0; ///< smallest gap at q of the pairs that were near; infinity when none was
    int table = -1; ///< index of the table of that pair, -1 when none was near
    int test = -1;  ///< its test in that table
};

/// What keeps a joint out of collision at run time: everything a response needs, prepared once from the
/// tables on the joint (METHOD 5). Immutable; one responder serves any number of threads and instances, each
/// thread with a workspace of its own. A response allocates nothing, locks nothing and throws nothing.
///
/// Of a free start it promises: the result is free by the exact query of each table (gap > 0), so is every
/// pose on the way there, and it is no farther from the asked pose (as the limits clamp it) than the start,
/// in the metric |w (q - asked)|, w = weights(). The same input gives the same bits. A DOF whose limits are a
/// whole turn has no end: it goes the shorter way round, over where its limits meet too.
class JointResponder {
public:
    /// Fully: with vector kernels and a free pose to return to, some milliseconds of preparation. Once: for
    /// a single response, without them.
    enum class Preparation { Fully, Once };

    /// A joint with one table; the joint's values are those of its motion.
    explicit JointResponder(const Table& table, Preparation preparation = Preparation::Fully);

    /// A joint that several tables bear on; dofCount values. Throws InputError where they do not fit.
    JointResponder(std::span<const TableOnJoint> tables, int dofCount,
                   Preparation preparation = Preparation::Fully);

    JointWorkspace workspace() const;

    /// last, asked: dofCount values each, finite. Both are clamped into the limits first. workspace.held then
    /// says of each table whether it held the joint: of a joint that is not Free at least one did.
    JointAnswer respond(const double* last, const double* asked, JointWorkspace& workspace) const;

    int dofCount() const { return model_.dofCount; }
    const JointValues& weights() const { return model_.weights; }
    /// The gap that one table is kept at: 1.5 of its own epsilon, or a millionth of its largest spheres.
    double keptGap(std::size_t table = 0) const { return model_.groups[table].off; }
    /// A pose known to be free, towards which a joint returns from deeper than the tables know.
    const JointValues* freePose() const { return hasFreePose_ ? &freePose_ : nullptr; }

private:
    void findFreePose(const JointValues& rest);
    JointAnswer within(const JointValues& start, const JointValues& goal, JointWorkspace& ws) const;
    JointAnswer fromFree(const JointValues& start, const JointValues& goal, int legs,
                         JointWorkspace& ws) const;
    JointAnswer fromCollision(const JointValues& start, const JointValues& goal, double depth,
                              JointWorkspace& ws) const;
    JointAnswer judged(const JointValues& q, JointStatus status, JointWorkspace& ws) const;

    JointModel model_;
    JointValues freePose_{};
    bool hasFreePose_ = false;
    double knownDepth_ = 0; ///< least gapDepth of the tables
};

} // namespace tss
