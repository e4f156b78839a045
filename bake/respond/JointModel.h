#pragma once
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
#include <limits>
#include <memory>
#include <vector>

namespace tss {

/// Moves by more than this share of a DOF's range are made in parts, so that few pairs are near each.
inline constexpr double farMove = 1.0 / 8;

/// What the response needs to know of the tables on one joint. Immutable; shared between threads.
struct JointModel {
    struct Group {
        Motion motion;
        std::vector<int> dofs;         ///< place of each DOF of the motion among the joint's values
        std::vector<double> turnRates; ///< turnBound of each
        bool paths = false;            ///< some DOF is a path, whose rate jumps at its rows
        double contactOffset =
            0; ///< gap that its pairs are kept at: above its own epsilon, so that the models are free
        std::uint32_t firstPair = 0, lastPair = 0; ///< of each test, in their order
        int table = 0;
        std::shared_ptr<const TableTests> tests;
        std::shared_ptr<const PreparedTable> prepared; ///< to cull with, none where that would not pay
        int chain = -1;         ///< of the model, which begins as its motion does; -1: none
        bool clustered = false; ///< its table is in clusters: its pairs are listed for one way at a time ...
        std::shared_ptr<const PairTree> tree; ///< ... from this
        DofValues fastest{};                  ///< per DOF of the motion: the largest of its pairs' speeds
        Vec3 middle = Vec3::Zero();           ///< of the centres of B's spheres, in B's frame ...
        double spread = 0;                    ///< ... which are no farther from it than this
    };
    struct Pair {
        Vec3 a, b;                  ///< centres, each in its own body's frame
        double contactDistance = 0; ///< of the centres: the radii and the gap at rest
        std::uint32_t group = 0;
        std::uint32_t mover = 0; ///< its row of speeds, that of its sphere of B
    };

    /// DOFs that several groups have in common, the longest of their motions: placed once for all of them.
    struct Chain {
        Motion motion;
        std::vector<int> dofs; ///< as a group's
    };

    int dofCount = 0;
    DofValues lower{}, upper{};        ///< of a DOF of a whole turn a turn beyond the tables' on both sides
    DofValues first{}, range{};        ///< lower limit and extent of the tables'
    DofValues rest{};                  ///< within the limits, and within all planes where the tables' rest is
    std::array<bool, maxDofs> round{}; ///< a whole turn, which goes on where its limits meet
    DofValues weights{};   ///< largest lever of each DOF, scene units a unit of the DOF: z = w q (METHOD 5.4)
    DofValues perWeight{}; ///< 1 / weights
    std::vector<LimitPlane> planes;
    std::vector<Group> groups;
    std::vector<Chain> chains;     ///< where some group is in clusters: many groups, and none with paths
    std::vector<Pair> pairs;       ///< by group
    std::uint32_t moverCount = 0;  ///< spheres of B that have a row
    std::vector<double> speeds;    ///< rows of dofCount: speed bound per unit of each value of the joint
    std::vector<double> levers;    ///< of each row: gaps change by at most lever * |w (q - q')|
    double scale = 0;              ///< length of the limits' diagonal in the weighted metric, scene units
    double leastContactOffset = 0; ///< of the groups
    bool clustered = false;        ///< some group is
    std::size_t listable = 0;      ///< pairs of those that are not
    std::uint64_t id = 0;          ///< no other model has it

    const double* speed(std::uint32_t pair) const {
        return speeds.data() + std::size_t(pairs[pair].mover) * std::size_t(dofCount);
    }
    double lever(std::uint32_t pair) const { return levers[pairs[pair].mover]; }
    double contactOffset(std::uint32_t pair) const { return groups[pairs[pair].group].contactOffset; }
};

/// Throws InputError where the tables do not fit one joint: an index that is none, limits without overlap,
/// more than maxDofs DOFs.
/// prepare: make the vector kernels to cull with, worth it for more than one response.
JointModel makeJointModel(std::span<const TableOnJoint> tables, int dofCount, bool prepare);

/// A pair that can matter on the way, and the threshold its gap is held above.
struct NearPair {
    std::uint32_t pair = 0;
    double threshold = 0;
    double gap = 0;
    double rate = 0;         ///< of the gap, per unit of the way, set by `advance`
    double speed = 0;        ///< bound of |rate| on the way
    double acceleration = 0; ///< bound of -rate' on the way
    double lift = 0;         ///< what a slide asks above the threshold, room for the bend of its way
    DofValues gradient;      ///< of the gap, set by `linearise`
    int row = -1;            ///< of the slide's rows, -1: not among them; a demand d has the bound ...
    double rowScale = 0, rowOffset = 0; ///< ... rowScale * d + rowOffset there
};

/// A group as it stands, and where its joint's values are then: what asks again for the same place is served
/// at once.
struct PlacedGroup {
    MotionFrame frame;
    DofValues at;
    bool known = false;
};

/// A chain as far as it stands at these values.
struct PlacedChain {
    std::array<Pose, maxDofs + 1> before;
    std::array<DofTwist, maxDofs> twists;
    DofValues at;
    std::size_t count = 0; ///< DOFs
    PlacedChain() { before[0] = Pose::Identity(); }
};

/// What is known of a group in clusters from where it stood before: which tests had a gap of at most `range`
/// there. It spares asking the table again, and changes no answer.
struct KnownNear {
    static constexpr double nothing = -std::numeric_limits<double>::infinity();
    static constexpr std::uint32_t most = 128, bins = 16;
    std::vector<std::uint32_t>
        tests; ///< by the bins of their gaps, each as wide as the others, up to `range`
    std::array<std::uint32_t, bins> ends{}; ///< of the bins among the tests
    double range = nothing;
    double least = nothing; ///< gap of all tests of the table there
    Pose pose = Pose::Identity();
    double more = 0; ///< how much farther than needed is asked, so that there are neither many nor none

    /// Where it was last placed no test had a smaller gap than `clear`.
    double clear = nothing;
    DofValues values{}; ///< of its DOFs there
    MotionFrame frame;

    void forget() { range = least = clear = nothing; }
};

/// Bits of JointWorkspace::held().
enum : std::uint8_t {
    stoppedStep = 1,    ///< a way ended at this table's contact, and the joint stayed there
    touchedAtStart = 2, ///< the joint stood in its contact before
    passedBy = 4 ///< its contact ended the straight way, and the joint came to what was asked around it
};

/// What a JointWorkspace holds.
struct ResponseRoom {
    std::vector<NearPair> near; ///< grows where tables are in clusters
    std::size_t nearCount = 0;
    bool common =
        false; ///< all thresholds are one, that of a start in collision: they do not rise by themselves
    std::vector<std::uint32_t> active; ///< places in `near` of those that can matter on one way
    std::vector<std::uint32_t> found;  ///< tests of one table
    QpRows rows;
    std::vector<PlacedGroup> groups; ///< one per group
    std::vector<PlacedChain> chains;
    std::vector<Pose> ends;          ///< one per group: where a way would end ...
    std::vector<std::uint8_t> ended; ///< ... where that is known
    std::vector<std::uint8_t> held;  ///< one per group: 0, or by what it held the joint in the last response

    /// Of a model with tables in clusters: per pair the listing in which it came into the near list.
    std::vector<std::uint32_t> listed;
    std::uint32_t listing = 0;
    std::vector<KnownNear> known; ///< one per group, kept from one response to the next ...
    std::uint64_t knownOf = 0;    ///< ... to this model

    /// Empties the near list.
    void unlist() {
        nearCount = 0;
        if (++listing == 0) std::fill(listed.begin(), listed.end(), 0), listing = 1;
    }
};

ResponseRoom roomFor(const JointModel& model);

/// Places one group at q (values of the joint) into ws.groups.
void placeGroup(const JointModel& model, std::size_t group, const DofValues& q, const DofValues& step,
                ResponseRoom& ws);

/// Gap of a pair with the group's pose; normal (unit or less, from A to B) and the centre of B in A's frame.
inline double pairGap(const JointModel::Pair& pair, const Pose& pose, Vec3& centre, Vec3& normal) {
    centre = pose * pair.b;
    normal = centre - pair.a;
    const double distance = normal.norm();
    normal = distance > 0 ? Vec3(normal * (1 / distance)) : Vec3::UnitX();
    return distance - pair.contactDistance;
}

/// Fills ws.near with the pairs whose gap can fall to their threshold when each DOF changes by at most
/// travel[l] from q. Thresholds are min(contactOffset, gap at q), each of its own table. Pairs of tables in
/// clusters are none of them: see listOnStep (JointClusters.h).
void cull(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseRoom& ws);
/// The same, after what is in ws.near.
void cullMore(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseRoom& ws);

/// Leaves out near pairs that stay above their threshold wherever |w (q - q')| is at most `distance`; gaps
/// must be those at q.
void narrow(const JointModel& model, double distance, ResponseRoom& ws);

/// Gap and gradient of the near pairs from `first` on at q, one-sided towards `way` at rows of paths.
/// Thresholds above the gap fall to it, unless they are common.
void linearise(const JointModel& model, const DofValues& q, const DofValues& step, ResponseRoom& ws,
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

/// Largest share of its range that any DOF goes.
double shareOfRange(const JointModel& model, const DofValues& step);

/// Smallest level of all pairs of the model at q; infinity where there are none.
double smallestLevel(const JointModel& model, const DofValues& q, ResponseRoom& ws);

/// The nearest test of one table at q, as its plain query finds it: of few tests where the table is prepared
/// and q within its limits.
QueryResult nearestTest(const JointModel& model, std::size_t group, const DofValues& q, ResponseRoom& ws);

/// Adds limits and planes as rows about the goal, y = w (q + way - goal), each DOF staying within `trust` of
/// its range from q.
void addLimits(const JointModel& model, const DofValues& q, double trust, const DofValues& goal,
               QpRows& rows);

/// Clamps into the box of limits, then, where a plane is broken, to the nearest point inside in the weighted
/// metric (planes hold to 1e-12 of the range).
DofValues clampToLimits(const JointModel& model, const double* asked, ResponseRoom& ws);

/// Takes the values of whole turns into the tables' limits; others stay.
void wrapTurns(const JointModel& model, DofValues& q);

/// |w (x - y)|.
double weightedDistance(const JointModel& model, const DofValues& x, const DofValues& y);

} // namespace tss
