#pragma once
#include "bake/respond/JointStatus.h"
#include "bake/table/Query.h"
#include "bake/table/Table.h"

#include <cstdint>
#include <memory>

namespace tss {

struct ResponseBuffers;

/// A table that constrains a joint: dofs[k] is the place of DOF k of the table's motion among the joint's
/// values. Several tables may share a joint (a mandible against a skull, a tooth guard against both).
struct TableOnJoint {
    const Table* table = nullptr;
    std::vector<int> dofs;
};

/// A resolved pose. Only the first dofCount values of q are used.
struct JointAnswer {
    DofValues q{};
    JointStatus status = JointStatus::Free;
    double gap = 0; ///< smallest gap at q of the pairs that were near; infinity when none was
    int table = -1; ///< index of the table of that pair, -1 when none was near
    int test = -1;  ///< its test in that table
};

/// Buffers of a response, made once per thread by JointResponder::workspace().
class JointWorkspace {
public:
    explicit JointWorkspace(std::unique_ptr<ResponseBuffers> room);
    JointWorkspace(JointWorkspace&&) noexcept;
    JointWorkspace& operator=(JointWorkspace&&) noexcept;
    ~JointWorkspace();

    /// One per table: nonzero if its contact held the joint in the last response.
    std::span<const std::uint8_t> held() const;

private:
    friend class JointResponder;
    std::unique_ptr<ResponseBuffers> room_;
};

/// What keeps a joint out of collision at run time: everything a response needs, prepared once from the
/// tables on the joint (METHOD 5), in some milliseconds. Immutable; one responder serves any number of
/// threads and instances, each thread with a workspace of its own. A response locks nothing and throws
/// nothing, and allocates nothing but where tables over many DOFs are in clusters: the workspace grows then
/// to what came near at the worst.
///
/// Of a free start it promises: the result is free by the exact query of each table (gap > 0), so is every
/// pose on the way there, and it is no farther from the asked pose (as the limits clamp it) than the start,
/// in the metric |w (q - asked)|, w = weights(). The same input gives the same bits. A DOF whose limits are a
/// whole turn has no end: it goes the shorter way round, over where its limits meet too.
class JointResponder {
public:
    /// A joint with one table; the joint's values are those of its motion.
    explicit JointResponder(const Table& table);

    /// A joint that several tables constrain; dofCount values. Throws InputError where they do not fit.
    JointResponder(std::span<const TableOnJoint> tables, int dofCount);

    JointResponder(JointResponder&&) noexcept;
    JointResponder& operator=(JointResponder&&) noexcept;
    ~JointResponder();

    JointWorkspace workspace() const;

    /// last, asked: dofCount values each, of `last` finite; an asked value that is no finite number leaves
    /// its DOF where it was. Both are clamped into the limits first. workspace.held() then says of each table
    /// whether it held the joint: of a joint that is not Free at least one did.
    JointAnswer respond(const double* last, const double* asked, JointWorkspace& workspace) const;

    /// The nearest test of one table at q, dofCount finite values, with gap, point and normal as the plain
    /// query (Query.h) has them, in a small part of its time for large tables.
    QueryResult nearest(std::size_t table, const double* q, JointWorkspace& workspace) const;

    int dofCount() const;
    const DofValues& weights() const;
    /// The gap that one table's pairs are kept at: 1.5 times its epsilon, or a millionth of its largest
    /// spheres.
    double keptGap(std::size_t table = 0) const;
    /// A pose known to be free, towards which a joint returns from deeper than the tables know.
    const DofValues* freePose() const;

private:
    class Prepared;
    std::unique_ptr<const Prepared> prepared_;
};

} // namespace tss
