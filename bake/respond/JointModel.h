#pragma once
#include "bake/base/Infinity.h"
#include "bake/motion/JointQp.h"
#include "bake/motion/MotionFrame.h"
#include "bake/respond/JointResponder.h"
#include "bake/respond/PairTree.h"
#include "bake/table/PreparedTable.h"
#include "bake/table/Query.h"
#include "bake/table/TablePairs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace tss {

/// A move of a DOF by more than this share of its range is divided into legs, so that few pairs are near
/// each.
inline constexpr double farMove = 1.0 / 8;

/// The tables on one joint, prepared for the response. Immutable; shared between threads.
struct JointModel {
    /// One table; its index is that of the table as given to makeJointModel().
    struct Group {
        Motion motion;
        std::vector<int> dofs;         ///< index among the joint's values of each DOF of the motion
        std::vector<double> turnRates; ///< per DOF of the motion: turnBound(), radians per unit of its value
        bool paths = false;            ///< some DOF is a path, whose velocity jumps at its rows
        double contactOffset = 0; ///< gap to keep its pairs at, scene units: above the table's epsilon, so
                                  ///< that the full models do not touch either
        std::uint32_t firstPair = 0,
                      lastPair = 0; ///< range in `pairs`: one pair per test, in the tests' order
        std::shared_ptr<const TableTests> tests;
        std::shared_ptr<const PreparedTable> prepared; ///< vector kernels for culling
        int chain = -1;         ///< index in `chains` of one that begins with the motion's DOFs; -1: none
        bool clustered = false; ///< the table is so large that it is in clusters (METHOD 4): its near pairs
                                ///< are listed for one straight way at a time, with `tree`
        std::shared_ptr<const PairTree> tree; ///< null unless clustered
        DofValues fastest{};                  ///< per DOF of the motion: largest speed bound of its pairs
        Vec3 middle = Vec3::Zero();           ///< of a ball around the centres of B's spheres, in B's frame
        double spread = 0;                    ///< the ball's radius, scene units
    };
    struct Pair {
        Vec3 a, b;                  ///< sphere centres, each in its own body's frame
        double contactDistance = 0; ///< distance of the centres at contact: both radii and the gap at rest
        std::uint32_t group = 0;
        std::uint32_t speedRow = 0; ///< row in `speeds` and `levers`, shared by all pairs of its sphere of B
    };

    /// A kinematic chain whose first DOFs several groups share, so that their poses are computed once.
    struct Chain {
        Motion motion;
        std::vector<int> dofs; ///< as Group::dofs
    };

    int dofCount = 0;
    DofValues lower{}, upper{}; ///< limits; of a periodic DOF a turn beyond the tables' limits on both sides
    DofValues first{}, range{}; ///< lower limit of the tables, and upper less lower
    DofValues rest{};           ///< within the limits, and within all planes where the tables' rest is
    std::array<bool, maxDofs> periodic{}; ///< the limits of the DOF are a whole turn: it has no end
    DofValues weights{};   ///< largest lever of each DOF, scene units a unit of the DOF: z = w q (METHOD 5.4)
    DofValues perWeight{}; ///< 1 / weights
    std::vector<LimitPlane> planes; ///< of all tables, coefficients per value of the joint
    std::vector<Group> groups;      ///< one per table
    std::vector<Chain> chains;      ///< empty unless some group is clustered
    std::vector<Pair> pairs;        ///< of all groups, one group after the other
    std::uint32_t speedRows = 0;
    std::vector<double> speeds;    ///< #speedRows rows of dofCount: bound on the speed of a sphere of B per
                                   ///< unit of each value of the joint
    std::vector<double> levers;    ///< #speedRows: a gap changes by at most lever * |w (q - q')|
    double scale = 0;              ///< length of the limits' diagonal in the weighted metric, scene units
    double leastContactOffset = 0; ///< smallest of the groups, scene units
    bool clustered = false;        ///< some group is
    std::size_t unclusteredPairs = 0; ///< number of pairs of groups that are not
    std::uint64_t id = 0;             ///< unique to this model

    const double* speed(std::uint32_t pair) const {
        return speeds.data() + std::size_t(pairs[pair].speedRow) * std::size_t(dofCount);
    }
    double lever(std::uint32_t pair) const { return levers[pairs[pair].speedRow]; }
    double contactOffset(std::uint32_t pair) const { return groups[pairs[pair].group].contactOffset; }
};

/// Throws InputError where the tables do not fit one joint: an index that is none, limits without overlap,
/// more than maxDofs DOFs.
JointModel makeJointModel(std::span<const TableOnJoint> tables, int dofCount);

/// A pair that may come into contact on a way, and the constraint on it: gap >= threshold. A way is a
/// straight line in joint space, gone through in unit time.
struct NearPair {
    std::uint32_t pair = 0;  ///< index in JointModel::pairs
    double threshold = 0;    ///< scene units
    double gap = 0;          ///< where the joint is, scene units
    double rate = 0;         ///< d gap / dt there, set by advance()
    double speed = 0;        ///< bound of |rate| on the way
    double acceleration = 0; ///< bound of -d rate / dt on the way
    double lift = 0;    ///< margin above the threshold that a slide asks of the linearised gap, since the
                        ///< true gap is curved
    DofValues gradient; ///< d gap / dq, set by linearise()
    int row = -1;       ///< its row of the slide's quadratic programme, -1: none
    double rowScale = 0, rowOffset = 0; ///< linearised gap >= g is the row's bound rowScale * g + rowOffset
};

/// The pose and twists of a group, with the values that they were computed for: asked again for the same
/// values, placeGroup() keeps them.
struct PlacedGroup {
    MotionFrame frame;
    DofValues at; ///< values of the group's DOFs
    bool valid = false;
};

/// The poses and twists of the first `count` DOFs of a chain, see evaluateLinks(), with their values.
struct PlacedChain {
    std::array<Pose, maxDofs + 1> before;
    std::array<DofTwist, maxDofs> twists;
    DofValues at;
    std::size_t count = 0;
    PlacedChain() { before[0] = Pose::Identity(); }
};

/// Results of the last searches for near tests of a clustered group (METHOD 5.1). They answer the next ones
/// while the body has moved little, and change no result.
struct NearCache {
    static constexpr double nothing = -infinity;
    static constexpr std::uint32_t most = 128, bins = 16;

    // The last search that found at most `most` tests: all tests with a gap of at most `range` at `pose`.
    std::vector<std::uint32_t> tests;          ///< sorted into bins of equal width by their gaps
    std::array<std::uint32_t, bins> binEnds{}; ///< end of each bin among the tests
    double range = nothing;                    ///< scene units; `nothing`: no search yet
    double smallestGap = nothing;              ///< of all tests of the table at `pose`, at most range
    Pose pose = Pose::Identity();
    double extraRange = 0; ///< by how much farther than needed the next search goes, adapted to what it finds

    // Where the group was last placed: no test had a smaller gap than `clearance`.
    double clearance = nothing;
    DofValues values{}; ///< of the group's DOFs there
    MotionFrame frame;  ///< there

    void clear() { range = smallestGap = clearance = nothing; }
};

/// Bits of JointWorkspace::held().
enum : std::uint8_t {
    stoppedStep = 1,    ///< a way ended at this table's contact, and the joint stayed there
    touchedAtStart = 2, ///< the joint was in contact by this table at the start
    passedBy = 4 ///< its contact ended the straight way, but sliding took the joint past it to the goal
};

/// The buffers that a JointWorkspace holds, for one model.
struct ResponseBuffers {
    std::vector<NearPair> near; ///< the first nearCount are in use; grows where groups are clustered
    std::size_t nearCount = 0;
    bool commonThreshold = false;      ///< pushOut() sets all thresholds, which then do not follow the gaps
    std::vector<std::uint32_t> active; ///< indices in `near` of those that may stop the current way
    std::vector<std::uint32_t> found;  ///< tests found in one table
    QpRows rows;
    std::vector<PlacedGroup> groups; ///< one per group
    std::vector<PlacedChain> chains;
    std::vector<Pose> ends;          ///< one per group: its pose at the end of a way, where `ended` is set
    std::vector<std::uint8_t> ended; ///< one per group
    std::vector<std::uint8_t> held;  ///< one per group: bits of how it held the joint in the last response

    // Of a model with clustered groups:
    std::vector<std::uint32_t> listed; ///< per pair: the value of `listing` when it was last listed as near
    std::uint32_t listing = 0;         ///< incremented each time that the near list is emptied
    std::vector<NearCache> caches;     ///< one per group, kept from one response to the next
    std::uint64_t cachesOf = 0;        ///< JointModel::id that the caches are about

    /// Removes the near pairs for which a predicate holds.
    template <class Predicate>
    void removeNear(const Predicate& predicate) {
        const auto end = near.begin() + std::ptrdiff_t(nearCount);
        nearCount = std::size_t(std::remove_if(near.begin(), end, predicate) - near.begin());
    }

    /// Empties the near list.
    void clearNear() {
        nearCount = 0;
        if (++listing == 0) std::fill(listed.begin(), listed.end(), 0), listing = 1;
    }
};

ResponseBuffers buffersFor(const JointModel& model);

/// Computes pose and twists of one group at q (values of the joint) into ws.groups. step: at a row of a path
/// the twist beyond it in this direction is meant.
void placeGroup(const JointModel& model, std::size_t group, const DofValues& q, const DofValues& step,
                ResponseBuffers& ws);

/// Gap of a pair with the group's pose; normal (unit or less, from A to B) and the centre of B in A's frame.
inline double pairGap(const JointModel::Pair& pair, const Pose& pose, Vec3& centre, Vec3& normal) {
    centre = pose * pair.b;
    normal = centre - pair.a;
    const double distance = normal.norm();
    normal = distance > 0 ? Vec3(normal * (1 / distance)) : Vec3::UnitX();
    return distance - pair.contactDistance;
}

/// Fills ws.near with the pairs whose gap can fall to their threshold when each DOF changes by at most
/// travel[l] from q. Thresholds are min(contactOffset, gap at q), each of its own table. Pairs of clustered
/// groups are not among them: see listOnStep() (JointClusters.h).
void cull(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseBuffers& ws);
/// The same, appended to ws.near.
void cullMore(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseBuffers& ws);

/// Removes near pairs whose gap stays above their threshold wherever |w (q - q')| is at most `distance`.
/// Their gaps must be those at q.
void narrow(const JointModel& model, double distance, ResponseBuffers& ws);

/// Computes gap and gradient at q of the near pairs from index `first` on; at a row of a path the gradient is
/// that in the direction of `step`. Thresholds above the gap are lowered to it, unless ws.commonThreshold.
void linearise(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws,
               std::size_t first = 0);

/// The tables of one joint keep different gaps (contactOffset). A level makes gaps of different tables
/// comparable: a gap > 0 is scaled so that every table's contactOffset becomes the smallest of them; a gap <=
/// 0 stays as it is. Monotone.
inline double levelOf(const JointModel& model, double contactOffset, double gap) {
    return gap > 0 ? gap * (model.leastContactOffset / contactOffset) : gap;
}
/// And back.
inline double gapOf(const JointModel& model, double contactOffset, double level) {
    return level > 0 ? level * (contactOffset / model.leastContactOffset) : level;
}

/// q + t * step.
inline DofValues along(const JointModel& model, DofValues q, const DofValues& step, double t) {
    for (int l = 0; l < model.dofCount; ++l) q[l] += t * step[l];
    return q;
}

/// share * (goal - q).
inline DofValues partOfStep(const JointModel& model, const DofValues& q, const DofValues& goal,
                            double share) {
    DofValues step{};
    for (int l = 0; l < model.dofCount; ++l) step[l] = share * (goal[l] - q[l]);
    return step;
}

/// Largest share of its range by which any DOF changes in a step.
double shareOfRange(const JointModel& model, const DofValues& step);

/// Smallest level of all pairs of the model at q; infinity where there are none.
double smallestLevel(const JointModel& model, const DofValues& q, ResponseBuffers& ws);

/// The nearest test of one table at q, with the same bits as query() over all tests. Where q is within its
/// limits only the few tests within the kernels' rounding are evaluated exactly.
QueryResult nearestTest(const JointModel& model, std::size_t group, const DofValues& q, ResponseBuffers& ws);

/// Adds limits and planes as rows in the unknowns y = w (q + step - goal). trust: share of its range by which
/// each DOF may move from q (trust region).
void addLimits(const JointModel& model, const DofValues& q, double trust, const DofValues& goal,
               QpRows& rows);

/// Clamps into the box of limits, then, where a plane is broken, to the nearest point inside in the weighted
/// metric (planes hold to 1e-12 of the range).
DofValues clampToLimits(const JointModel& model, const double* asked, ResponseBuffers& ws);

/// Brings the values of periodic DOFs into the tables' limits; others stay.
void wrapTurns(const JointModel& model, DofValues& q);

/// |w (x - y)|.
double weightedDistance(const JointModel& model, const DofValues& x, const DofValues& y);

} // namespace tss
