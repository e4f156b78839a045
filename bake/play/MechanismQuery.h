#pragma once
#include "bake/play/ChainPoses.h"
#include "bake/table/PreparedTable.h"

#include <cstdint>
#include <vector>

namespace tss {

/// What is known of all pairs of a scene at one configuration.
struct MechanismAnswer {
    enum class Verdict : std::uint8_t {
        Free,    ///< none touches
        Contact, ///< `pair` touches, and perhaps others
        Beyond,  ///< some values lie outside the limits that tables or proofs were made for, and no pair that
                 ///< is within its own touches
    };
    Verdict verdict = Verdict::Free;
    int pair = -1; ///< of the scene: the first that was found to touch; -1: none
};

/// Room for one question, made once per thread by MechanismQuery::workspace.
struct MechanismWorkspace {
    std::vector<ChainPoses::Matrix> places; ///< one a body
    std::vector<double> limited;            ///< one a value
};

/// A whole mechanism as one question: whether any pair of bodies touches, given a value for every DOF of all
/// joints. Each pair answers as its own table does, to the rounding band of that; pairs that are proven never
/// to meet cost nothing. What the tables have in common is worked out once: the sines and cosines of the
/// joints, and where each body stands. Pairs are asked in the order that ends soonest, found by asking
/// sampled configurations when it is made; the order says which pair is named where several touch, and
/// changes no verdict. Immutable once made; shared between threads.
class MechanismQuery {
public:
    /// Tables and proofs are taken to be those of this scene as it is (staleness()); pairs without either are
    /// left out, see unanswered(). order: indices of pairs with a table, all of them, to be asked in that
    /// order. Throws InputError for a table that does not fit its joints.
    explicit MechanismQuery(const SceneModel& scene, const std::vector<int>& order = {});

    /// One a DOF of all joints of the scene, in file order, DOFs in the joint's order: radians and scene
    /// units.
    std::size_t valueCount() const { return lower_.size(); }
    /// Pairs that have neither table nor proof.
    const std::vector<int>& unanswered() const { return unanswered_; }
    /// The pairs with a table in the order in which they are asked.
    std::vector<int> order() const;
    /// Pairs that are proven never to meet.
    std::size_t provenCount() const { return parts_.size() - tables_.size(); }

    MechanismWorkspace workspace() const;

    /// values: valueCount(), finite.
    MechanismAnswer ask(const double* values, MechanismWorkspace& ws) const;

private:
    /// The values of one pair, and the limits that its table or proof was made for.
    struct Part {
        int pair = -1;
        Motion motion;
        std::vector<std::uint32_t> values; ///< of each DOF, its place among all values
        bool inARow = false;               ///< these places are one after the other
    };
    struct Asked {
        std::uint32_t part = 0;
        PreparedTable table;
        bool placed = false; ///< the pose is had from the bodies' places
        int bodyA = -1, bodyB = -1;
        Vec3 a, b; ///< where these centres, each in its own body's frame, are farther apart than ...
        double farSquared = 0; ///< ... its root, no test touches
    };

    Part partOf(const SceneModel& scene, int pair) const;
    void addTable(const SceneModel& scene, std::uint32_t part);
    void findOrder();
    bool within(const double* values) const;
    const double* ownValues(const Part& part, const double* values, double* room) const;
    bool beyond(const Part& part, const double* values) const;
    bool touches(const Asked& asked, const double* values, const ChainPoses::Matrix* places) const;
    /// The values, those beyond the limits replaced: for places, of which the pairs that have such a value
    /// make no use.
    const double* limited(const double* values, MechanismWorkspace& ws) const;
    /// Of one that no table within its limits touches.
    MechanismAnswer untouched(const double* values, bool within) const;

    std::size_t bodyCount_ = 0;
    std::vector<double> lower_, upper_; ///< per value: of the joints that some pair has; infinite of others
    bool planes_ = false;
    std::vector<Part> parts_; ///< of all tables and proofs
    ChainPoses chain_;
    std::vector<Asked> tables_; ///< in the order in which they are asked
    std::vector<int> unanswered_;
};

} // namespace tss
