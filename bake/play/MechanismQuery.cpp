#include "bake/play/MechanismQuery.h"

#include "bake/base/Error.h"
#include "bake/model/CheckIndices.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/DofUnits.h"
#include "bake/play/ChainPoses.h"
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <random>

namespace tss {

namespace {

/// The estimated cost of asking a table, in units of a look-up in its verdict grid; only orders the pairs.
/// placed: the pose is calculated from the bodies' places.
double costOf(const PreparedTable& table, bool placed) {
    constexpr double pose = 20, placedPose = 4, tests = 10;
    const double asked = (placed ? placedPose : pose) + tests;
    return table.verdicts().empty() ? asked : 1 + table.verdicts().asked() * asked;
}

/// A uniformly distributed value, the same on every machine.
double between(std::mt19937_64& random, double lower, double upper) {
    return lower + (upper - lower) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

} // namespace

class MechanismQuery::Prepared {
public:
    explicit Prepared(const SceneModel& scene);
    std::size_t valueCount() const { return lower_.size(); }
    const std::vector<int>& unanswered() const { return unanswered_; }
    MechanismWorkspace workspace() const;
    MechanismAnswer ask(const double* values, MechanismWorkspace& ws) const;
    void ask(const double* values, std::size_t count, MechanismAnswer* answers, MechanismWorkspace& ws) const;

private:
    /// Configurations that are evaluated together in vector lanes.
    struct Lanes {
        std::array<const double*, poseLanes> values;
        std::array<MechanismAnswer*, poseLanes> answers;
        std::uint32_t count = 0;
    };
    /// The values of one pair, and the limits that its table or proof was made for.
    struct Part {
        int pair = -1;
        Motion motion;
        std::vector<std::uint32_t> values; ///< of each DOF, its place among all values
        bool contiguous = false;           ///< these places follow one another
    };
    /// A table with what it takes to ask it.
    struct Asked {
        std::uint32_t part = 0;
        PreparedTable table;
        bool placed = false; ///< the pose is calculated from the bodies' places
        int bodyA = -1, bodyB = -1;
        Vec3 a, b;             ///< centres of two balls about the table's spheres, each in its body's frame
        double farSquared = 0; ///< no test touches where a and b are farther apart than the root of this
    };

    Part partOf(const SceneModel& scene, int pair) const;
    void addTable(const SceneModel& scene, std::uint32_t part);
    void findOrder();
    bool within(const double* values) const;
    /// The values of a part in a row: among all values, or copied to the buffer.
    const double* ownValues(const Part& part, const double* values, double* buffer) const;
    bool beyond(const Part& part, const double* values) const;
    bool touches(const Asked& asked, const double* values, const ChainPoses::Matrix* places) const;
    bool touchesUnplaced(const Asked& asked, const double* values) const;
    /// Asks the tables that need places of all of these.
    void askPlaced(Lanes& lanes, MechanismWorkspace& ws) const;
    /// The values with those beyond the limits replaced, for calculating places. Pairs that depend on a
    /// replaced value are not asked.
    const double* limited(const double* values, MechanismWorkspace& ws) const;
    /// The answer for a configuration at which no table within its limits touches.
    MechanismAnswer untouched(const double* values, bool within) const;

    std::size_t bodyCount_ = 0;
    std::vector<double> lower_, upper_; ///< per value: of the joints that some pair has; infinite of others
    bool planes_ = false;
    std::vector<Part> parts_; ///< of all tables and proofs
    ChainPoses chain_;
    std::vector<Asked> tables_; ///< in the order in which they are asked
    std::vector<int> unanswered_;
};

MechanismQuery::Prepared::Prepared(const SceneModel& scene) : bodyCount_(scene.bodies.size()) {
    checkIndices(scene);
    std::vector<int> chained, withTable;
    for (int k = 0; k < static_cast<int>(scene.pairs.size()); ++k) {
        const Pair& pair = scene.pairs[k];
        if (!pair.table && !pair.proof) {
            unanswered_.push_back(k);
        } else if (pair.table) {
            withTable.push_back(k);
            if (pair.table->motion.dofCount() > 3) chained.push_back(k);
        }
    }
    chain_ = ChainPoses(scene, chained);
    const std::size_t count = firstValues(scene).back();
    lower_.assign(count, -std::numeric_limits<double>::infinity());
    upper_.assign(count, std::numeric_limits<double>::infinity());

    for (const int k : withTable) {
        parts_.push_back(partOf(scene, k));
        addTable(scene, static_cast<std::uint32_t>(parts_.size() - 1));
    }
    for (int k = 0; k < static_cast<int>(scene.pairs.size()); ++k)
        if (!scene.pairs[k].table && scene.pairs[k].proof) parts_.push_back(partOf(scene, k));
    for (const Part& part : parts_) {
        planes_ = planes_ || !part.motion.planes.empty();
        for (std::size_t k = 0; k < part.values.size(); ++k) {
            const Dof& dof = part.motion.dofs[k];
            const double slack = limitRounding(dof, fileRounding); // as beyondLimits()
            lower_[part.values[k]] = std::max(lower_[part.values[k]], dof.lower - slack);
            upper_[part.values[k]] = std::min(upper_[part.values[k]], dof.upper + slack);
        }
    }
    findOrder();
}

MechanismQuery::Prepared::Part MechanismQuery::Prepared::partOf(const SceneModel& scene, int pair) const {
    const Pair& of = scene.pairs[pair];
    const std::vector<std::size_t> first = firstValues(scene);
    Part part{pair, of.table ? of.table->motion : pairMotion(scene, of), {}, true};
    for (const JointDof& dof : pairDofs(scene, of))
        part.values.push_back(static_cast<std::uint32_t>(first[dof.joint] + dof.dof));
    if (part.values.size() != part.motion.dofCount())
        throw InputError(Where{"", "", of.path}, "its joints have other degrees of freedom than its table");
    for (std::size_t k = 1; k < part.values.size(); ++k)
        part.contiguous = part.contiguous && part.values[k] == part.values[0] + k;
    return part;
}

void MechanismQuery::Prepared::addTable(const SceneModel& scene, std::uint32_t part) {
    const Pair& pair = scene.pairs[parts_[part].pair];
    const bool linked = pair.table->motion.dofCount() > FeatureForm::maxDofs && chain_.links(pair);
    const Table& table = *pair.table;
    double farthest = 0;
    for (const SphereSet* spheres : {&table.a, &table.b})
        for (const Sphere& sphere : *spheres) farthest = std::max(farthest, sphere.centre.norm());
    PrepareOptions options;
    if (linked) options.poseError = chain_.error(pair, farthest);
    Asked asked{part, PreparedTable(table, options), linked, pair.bodyA, pair.bodyB, {}, {}, 0};
    asked.placed = linked && asked.table.form() == KernelForm::Direct;
    if (asked.placed && table.testCount() > 0) {
        const TablePair bound = boundOf(tablePairs(table));
        asked.a = bound.a;
        asked.b = bound.b;
        // The rounding bands, within which the table itself counts contact, are added.
        const double far = bound.contactDistance + 2 * (asked.table.signBand() + options.poseError);
        asked.farSquared = far > 0 ? far * far : 0;
    }
    tables_.push_back(std::move(asked));
}

void MechanismQuery::Prepared::findOrder() {
    constexpr std::size_t samples = 2048;
    std::mt19937_64 random(1);
    MechanismWorkspace ws = workspace();
    std::vector<std::vector<bool>> touching(tables_.size(), std::vector<bool>(samples));
    std::vector<double> values(valueCount());
    for (std::size_t i = 0; i < samples; ++i) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = std::isfinite(lower_[k]) ? between(random, lower_[k], upper_[k]) : 0;
        chain_.evaluate(values.data(), ws.places.data());
        for (std::size_t t = 0; t < tables_.size(); ++t)
            touching[t][i] = touches(tables_[t], values.data(), ws.places.data());
    }
    // Greedy: next the table that finds contact at most of the open configurations for its cost.
    std::vector<bool> open(samples, true);
    for (auto next = tables_.begin(); next != tables_.end(); ++next) {
        auto best = next;
        double most = -1;
        for (auto t = next; t != tables_.end(); ++t) {
            std::size_t ended = 0;
            const std::vector<bool>& its = touching[t - tables_.begin()];
            for (std::size_t i = 0; i < samples; ++i) ended += open[i] && its[i];
            const double gain = (static_cast<double>(ended) + 1e-3) / costOf(t->table, t->placed);
            if (gain > most) most = gain, best = t;
        }
        const auto at = [&](auto t) { return touching.begin() + (t - tables_.begin()); };
        std::rotate(next, best, best + 1);
        std::rotate(at(next), at(best), at(best) + 1);
        for (std::size_t i = 0; i < samples; ++i) open[i] = open[i] && !(*at(next))[i];
    }
}

MechanismWorkspace MechanismQuery::Prepared::workspace() const {
    return {std::vector<ChainPoses::Matrix>(bodyCount_), std::vector<double>(valueCount()),
            std::vector<BodyLanes>(bodyCount_)};
}

bool MechanismQuery::Prepared::within(const double* values) const {
    int in = 1;
    for (std::size_t k = 0; k < lower_.size(); ++k)
        in &= static_cast<int>(values[k] >= lower_[k]) & static_cast<int>(values[k] <= upper_[k]);
    if (in == 0) return false;
    if (!planes_) return true;
    return std::ranges::none_of(
        parts_, [&](const Part& part) { return !part.motion.planes.empty() && beyond(part, values); });
}

const double* MechanismQuery::Prepared::ownValues(const Part& part, const double* values,
                                                  double* buffer) const {
    if (part.contiguous) return part.values.empty() ? values : values + part.values[0];
    for (std::size_t k = 0; k < part.values.size(); ++k) buffer[k] = values[part.values[k]];
    return buffer;
}

bool MechanismQuery::Prepared::beyond(const Part& part, const double* values) const {
    DofValues buffer;
    return beyondLimits(part.motion, {ownValues(part, values, buffer.data()), part.values.size()});
}

bool MechanismQuery::Prepared::touches(const Asked& asked, const double* values,
                                       const ChainPoses::Matrix* places) const {
    if (!asked.placed) return touchesUnplaced(asked, values);
    const ChainPoses::Matrix &a = places[asked.bodyA], &b = places[asked.bodyB];
    if (ChainPoses::squaredDistance(a, asked.a, b, asked.b) > asked.farSquared) return false;
    ChainPoses::Matrix between;
    ChainPoses::between(a, b, between);
    TableFeatures features;
    asked.table.features(between, features);
    return asked.table.hit(features);
}

bool MechanismQuery::Prepared::touchesUnplaced(const Asked& asked, const double* values) const {
    DofValues buffer;
    return asked.table.hit(ownValues(parts_[asked.part], values, buffer.data()));
}

const double* MechanismQuery::Prepared::limited(const double* values, MechanismWorkspace& ws) const {
    for (std::size_t k = 0; k < lower_.size(); ++k)
        ws.limited[k] = values[k] >= lower_[k] && values[k] <= upper_[k] ? values[k]
                        : std::isfinite(lower_[k])                       ? lower_[k]
                                                                         : 0;
    return ws.limited.data();
}

MechanismAnswer MechanismQuery::Prepared::untouched(const double* values, bool within) const {
    const bool out =
        !within && std::ranges::any_of(parts_, [&](const Part& part) { return beyond(part, values); });
    return {out ? MechanismAnswer::Verdict::Beyond : MechanismAnswer::Verdict::Free, -1};
}

MechanismAnswer MechanismQuery::Prepared::ask(const double* values, MechanismWorkspace& ws) const {
    const bool inside = within(values);
    bool placed = false;
    for (const Asked& asked : tables_) {
        if (!inside && beyond(parts_[asked.part], values)) continue;
        if (asked.placed && !placed) {
            chain_.evaluate(inside ? values : limited(values, ws), ws.places.data());
            placed = true;
        }
        if (touches(asked, values, ws.places.data()))
            return {MechanismAnswer::Verdict::Contact, parts_[asked.part].pair};
    }
    return untouched(values, inside);
}

void MechanismQuery::Prepared::ask(const double* values, std::size_t count, MechanismAnswer* answers,
                                   MechanismWorkspace& ws) const {
    Lanes lanes;
    for (std::size_t i = 0; i < count; ++i, values += valueCount()) {
        if (!within(values)) {
            answers[i] = ask(values, ws);
            continue;
        }
        answers[i] = {MechanismAnswer::Verdict::Free, -1};
        const auto touching = std::ranges::find_if(
            tables_, [&](const Asked& asked) { return !asked.placed && touchesUnplaced(asked, values); });
        if (touching != tables_.end()) {
            answers[i] = {MechanismAnswer::Verdict::Contact, parts_[touching->part].pair};
            continue;
        }
        lanes.values[lanes.count] = values;
        lanes.answers[lanes.count] = &answers[i];
        if (++lanes.count == poseLanes) askPlaced(lanes, ws);
    }
    if (lanes.count > 0) askPlaced(lanes, ws);
}

void MechanismQuery::Prepared::askPlaced(Lanes& lanes, MechanismWorkspace& ws) const {
    std::fill(lanes.values.begin() + lanes.count, lanes.values.end(), lanes.values[0]);
    chain_.evaluate(lanes.values.data(), ws.lanes.data());
    std::uint32_t open = (1u << lanes.count) - 1;
    lanes.count = 0;
    PoseLanes poses;
    for (auto asked = tables_.begin(); asked != tables_.end() && open != 0; ++asked) {
        if (!asked->placed) continue;
        const TableKernels& kernels = asked->table.kernels();
        const BodyLanes &a = ws.lanes[asked->bodyA], &b = ws.lanes[asked->bodyB];
        const std::uint32_t near =
            open & kernels.laneKernels().near(a, asked->a, b, asked->b, asked->farSquared);
        if (near == 0) continue;
        kernels.features(a, b, poses);
        const std::uint32_t touching = kernels.hits(poses, near);
        for (std::uint32_t left = touching; left != 0; left &= left - 1)
            *lanes.answers[std::countr_zero(left)] = {MechanismAnswer::Verdict::Contact,
                                                      parts_[asked->part].pair};
        open &= ~touching;
    }
}

MechanismQuery::MechanismQuery(const SceneModel& scene)
    : prepared_(std::make_unique<const Prepared>(scene)) {}
MechanismQuery::MechanismQuery(MechanismQuery&&) noexcept = default;
MechanismQuery& MechanismQuery::operator=(MechanismQuery&&) noexcept = default;
MechanismQuery::~MechanismQuery() = default;

std::size_t MechanismQuery::valueCount() const {
    return prepared_->valueCount();
}

const std::vector<int>& MechanismQuery::unanswered() const {
    return prepared_->unanswered();
}

MechanismWorkspace MechanismQuery::workspace() const {
    return prepared_->workspace();
}

MechanismAnswer MechanismQuery::ask(const double* values, MechanismWorkspace& ws) const {
    return prepared_->ask(values, ws);
}

void MechanismQuery::ask(const double* values, std::size_t count, MechanismAnswer* answers,
                         MechanismWorkspace& ws) const {
    prepared_->ask(values, count, answers, ws);
}

} // namespace tss
