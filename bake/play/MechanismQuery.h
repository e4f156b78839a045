#pragma once
#include "bake/model/SceneModel.h"
#include "bake/table/PoseLanes.h"

#include <array>
#include <cstdint>
#include <memory>
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

/// Room for questions, made once per thread by MechanismQuery::workspace.
struct MechanismWorkspace {
    std::vector<std::array<double, 12>> places; ///< one per body: 3 by 4, row-major, rotation first
    std::vector<double> limited;                ///< one per value
    std::vector<BodyLanes> lanes;               ///< one per body, in poseLanes configurations
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
    /// left out, see unanswered(). Throws InputError for a table that does not fit its joints, and for
    /// indices beyond the scene's bodies and joints.
    explicit MechanismQuery(const SceneModel& scene);
    MechanismQuery(MechanismQuery&&) noexcept;
    MechanismQuery& operator=(MechanismQuery&&) noexcept;
    ~MechanismQuery();

    /// One per DOF of all joints of the scene, in file order, DOFs in the joint's order: radians and scene
    /// units. posedBodies() says where the bodies stand at such values.
    std::size_t valueCount() const;
    /// Pairs that have neither table nor proof.
    const std::vector<int>& unanswered() const;

    MechanismWorkspace workspace() const;

    /// values: valueCount(), finite.
    MechanismAnswer ask(const double* values, MechanismWorkspace& ws) const;

    /// Many configurations: values has a row of valueCount() for each, answers room for as many. The tables
    /// that need no places are asked of each configuration; those that this leaves open go on side by side,
    /// so that joints and places are worked out in vectors. Verdicts are those of the above, but where
    /// rounding decides; of several pairs that touch another one may be named.
    void ask(const double* values, std::size_t count, MechanismAnswer* answers, MechanismWorkspace& ws) const;

private:
    class Prepared;
    std::unique_ptr<const Prepared> prepared_;
};

} // namespace tss
