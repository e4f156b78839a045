#include "tests/adversary/judge/Attack.h"

#include "bake/table/PreparedTable.h"
#include "bake/table/Query.h"
#include "tests/adversary/judge/Surfaces.h"
#include "tests/search/Scenes.h"
#include "tests/table/ExactGap.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <optional>

namespace adversary {

namespace {

using namespace tss;
using Values = std::vector<double>;

/// What one pose is like, for the search.
struct Seen {
    bool meet = false;  ///< by the meshes
    bool fires = false; ///< by the table
    bool hit = false;   ///< by its kernel
    double gap = std::numeric_limits<double>::infinity();
};

/// Judges single poses.
class Judge {
public:
    Judge(const Surfaces& surfaces, const Motion& motion) : surfaces(surfaces), motion(motion) {}
    virtual ~Judge() = default;
    /// Nothing outside of the limits.
    virtual std::optional<Seen> look(const Values& q) = 0;

    const Surfaces& surfaces;
    const Motion& motion;
    Findings found;

protected:
    void fail(std::uint64_t& count, const Values& q, const std::string& what) {
        ++count;
        if (!found.worst.empty()) return;
        found.worst = q;
        found.what = fmt::format("{} at q = [{}]", what, fmt::join(q, ", "));
    }
};

class TableJudge final : public Judge {
public:
    TableJudge(const Surfaces& surfaces, const Motion& motion, const Table& table, bool claims)
        : Judge(surfaces, motion), table_(table), prepared_(table), pairs_(tablePairs(table)),
          near_(4 * prepared_.signBand() + 1e-10 * surfaces.size()), claims_(claims) {}

    std::optional<Seen> look(const Values& q) override {
        if (!withinLimits(motion, q)) return {};
        const Pose at = pose(motion, q);
        Seen seen{surfaces.meet(at), false, false, query(table_, q).gap};
        seen.fires = seen.gap <= 0;
        ++found.poses;
        found.contacts += seen.meet;
        found.fired += seen.fires;
        if (seen.meet) judgeMiss(q, at, seen.gap);
        if (seen.fires) judgeEarly(q, at);
        judgeKernel(q, seen);
        return seen;
    }

private:
    void judgeMiss(const Values& q, const Pose& at, double gap) {
        if (!claims_ || !table_.boundMiss) return;
        const double late = gap - *table_.boundMiss;
        if (late <= surfaces.rounding(at)) return;
        if (!surfaces.surelyMeet(at)) {
            ++found.doubts;
            return;
        }
        found.latest = std::max(found.latest, late);
        fail(found.missed, q, fmt::format("contact, gap {:.6g}, boundMiss {:.6g}", gap, *table_.boundMiss));
    }

    void judgeEarly(const Values& q, const Pose& at) {
        if (!claims_ || !table_.boundEarly) return;
        const double allowed = *table_.boundEarly + surfaces.rounding(at);
        if (!surfaces.apart(at, allowed)) return;
        const double distance = surfaces.distance(at);
        if (distance <= allowed || surfaces.fillingsNear(at, allowed)) return;
        if (surfaces.meet(at) || surfaces.distanceByFcl(at) <= allowed) {
            ++found.doubts;
            return;
        }
        found.earliest = std::max(found.earliest, distance);
        fail(found.early, q,
             fmt::format("reported {:.6g} apart, boundEarly {:.6g}", distance, *table_.boundEarly));
    }

    /// What a kernel says is held against gaps that are not rounded to double anywhere, T(q) neither, and
    /// against those that anybody sees who calculates them.
    void judgeKernel(const Values& q, Seen& seen) {
        if (table_.testCount() == 0) return;
        seen.hit = prepared_.hit(q.data());
        if (seen.hit == seen.fires && std::abs(seen.gap) > near_) return;
        const long double gap = exact::gap(motion, pairs_, q), band = prepared_.signBand();
        const bool so = seen.hit ? gap <= band && seen.gap <= band : gap > 0 && seen.gap > -band;
        if (!so)
            fail(found.kernel, q,
                 fmt::format("the kernel says {}, the gap is {:.3g}, in double {:.3g}, its band {:.3g}",
                             seen.hit ? "contact" : "free", static_cast<double>(gap), seen.gap,
                             prepared_.signBand()));
    }

    const Table& table_;
    PreparedTable prepared_;
    std::vector<TablePair> pairs_;
    double near_; ///< gaps at which the kernel is looked at closely
    bool claims_;
};

class ProofJudge final : public Judge {
public:
    ProofJudge(const Surfaces& surfaces, const Motion& motion, const NeverCollides& proof)
        : Judge(surfaces, motion), clearance_(proof.clearance) {}

    std::optional<Seen> look(const Values& q) override {
        if (!withinLimits(motion, q)) return {};
        const Pose at = pose(motion, q);
        Seen seen{surfaces.meet(at), false, false, 0};
        ++found.poses;
        found.contacts += seen.meet;
        const double claimed = clearance_ - surfaces.rounding(at);
        if (!seen.meet && surfaces.apart(at, claimed)) return seen;
        const double distance = surfaces.clearance(at);
        if (distance >= claimed) return seen; // only what is exempt is near
        found.latest = std::max(found.latest, clearance_ - distance);
        fail(found.missed, q,
             fmt::format("never nearer than {:.6g}, but {:.6g} apart", clearance_, distance));
        return seen;
    }

private:
    double clearance_;
};

/// After so many failures it is clear.
constexpr std::uint64_t enough = 100;

/// Chooses the poses.
class Search {
public:
    Search(Judge& judge, const AttackOptions& options)
        : judge_(judge), motion_(judge.motion), random_(options.seed * 0x9E3779B97F4A7C15u + 3),
          budget_(options.poses), until_(processorSeconds() + options.seconds) {}

    void run() {
        if (emptyLimits()) return;
        atRest();
        corners();
        rows();
        while (spent() < 0.35) consider(anywhere());
        while (spent() < 0.6 && bisect()) {
        }
        while (spent() < 1) {
            const auto before = judge_.found.poses;
            climb();
            if (judge_.found.poses == before && ++idle_ > 100) break; // Q is empty, or all but
        }
    }

private:
    /// The planes leave no pose, or so little that none is found.
    bool emptyLimits() {
        if (motion_.planes.empty()) return false;
        for (int k = 0; k < 200; ++k)
            if (withinLimits(motion_, anywhere())) return false;
        return true;
    }

    double spent() {
        const Findings& found = judge_.found;
        if (found.missed + found.early + found.kernel >= enough) return 2;
        // Where planes leave little of the box most draws cost nothing but time.
        if (++draws_ > 50 * budget_ + 1000) return 2;
        if (10 * found.poses > budget_ && processorSeconds() > until_) return 2;
        return double(found.poses) / double(budget_);
    }

    std::optional<Seen> consider(const Values& q) {
        const std::optional<Seen> seen = judge_.look(q);
        if (!seen) return seen;
        keep(seen->meet ? meeting_ : free_, q);
        keep(seen->fires ? firing_ : silent_, q);
        return seen;
    }

    void keep(std::vector<Values>& list, const Values& q) {
        if (list.size() < 64)
            list.push_back(q);
        else
            list[static_cast<std::size_t>(random_.below(64))] = q;
    }

    Values anywhere() {
        Values q;
        for (const Dof& dof : motion_.dofs) q.push_back(random_.in(dof.lower, dof.upper));
        return motion_.planes.empty() || random_.below(4) ? q : clampToLimits(motion_, q);
    }

    /// Off by about `share` of the limits in some of the DOFs.
    Values near(Values q, double share) {
        for (std::size_t k = 0; k < q.size(); ++k) {
            const Dof& dof = motion_.dofs[k];
            if (random_.below(3) == 0) continue;
            q[k] =
                std::clamp(q[k] + share * random_.in(-1, 1) * (dof.upper - dof.lower), dof.lower, dof.upper);
        }
        return q;
    }

    void atRest() {
        Values rest = restValues(motion_);
        for (std::size_t k = 0; k < rest.size(); ++k)
            rest[k] = std::clamp(rest[k], motion_.dofs[k].lower, motion_.dofs[k].upper);
        consider(rest);
        for (double share = 0.3; share > 1e-10; share *= 0.3) consider(near(rest, share));
    }

    void corners() {
        const std::size_t count = std::size_t{1} << std::min<std::size_t>(motion_.dofCount(), 5);
        for (std::size_t corner = 0; corner < count; ++corner) {
            Values q;
            for (std::size_t k = 0; k < motion_.dofCount(); ++k)
                q.push_back(corner >> k & 1 ? motion_.dofs[k].upper : motion_.dofs[k].lower);
            consider(q);
            consider(clampToLimits(motion_, q));
            consider(near(q, 0.01));
        }
    }

    void rows() {
        for (std::size_t k = 0; k < motion_.dofCount(); ++k)
            for (const PathRow& row : motion_.dofs[k].path)
                for (const double way : {-1e300, 0., 1e300}) {
                    Values q = anywhere();
                    q[k] = std::clamp(way == 0 ? row.value : std::nextafter(row.value, way),
                                      motion_.dofs[k].lower, motion_.dofs[k].upper);
                    consider(q);
                }
    }

    const Values& any(const std::vector<Values>& list) {
        return list[static_cast<std::size_t>(random_.below(static_cast<int>(list.size())))];
    }

    /// Between contact and its absence, by the meshes, the table and its kernel in turn.
    bool bisect() {
        const bool byMeshes = !meeting_.empty() && !free_.empty(),
                   byTable = !firing_.empty() && !silent_.empty();
        if (!byMeshes && !byTable) return false;
        const bool Seen::*said = byMeshes && (!byTable || random_.below(2)) ? &Seen::meet
                                 : random_.below(3)                         ? &Seen::fires
                                                                            : &Seen::hit;
        const bool meshes = said == &Seen::meet;
        Values out = any(meshes ? free_ : silent_), in = any(meshes ? meeting_ : firing_);
        for (int step = 0; step < 44; ++step) {
            Values middle(in.size());
            for (std::size_t k = 0; k < in.size(); ++k) middle[k] = 0.5 * (in[k] + out[k]);
            if (middle == in || middle == out) break;
            const std::optional<Seen> seen = consider(middle);
            if (!seen) break;
            ((*seen).*said ? in : out) = middle;
        }
        return true;
    }

    /// Larger is better; nothing: not allowed.
    using Score = std::function<std::optional<double>(const Values&, const Seen&)>;

    void climb(Values q, const Score& score) {
        const std::optional<Seen> start = consider(q);
        if (!start) return;
        std::optional<double> best = score(q, *start);
        if (!best) return;
        for (double share = 0.2; share > 1e-9; share *= 0.4)
            for (int tries = 0; tries < 4; ++tries) {
                const Values next = near(q, share);
                const std::optional<Seen> seen = consider(next);
                if (!seen) continue;
                const std::optional<double> value = score(next, *seen);
                if (!value || *value <= *best) continue;
                best = value;
                q = next;
                tries = 0;
                if (spent() >= 1) return;
            }
    }

    void climb() {
        const Score late = [](const Values&, const Seen& seen) -> std::optional<double> {
            if (!seen.meet) return {};
            return seen.gap;
        };
        const Score far = [this](const Values& q, const Seen& seen) -> std::optional<double> {
            if (!seen.fires) return {};
            return judge_.surfaces.distance(pose(motion_, q));
        };
        const Score nearer = [this](const Values& q, const Seen&) -> std::optional<double> {
            return -judge_.surfaces.clearance(pose(motion_, q));
        };
        switch (random_.below(3)) {
        case 0:
            return meeting_.empty() ? climb(anywhere(), nearer) : climb(any(meeting_), late);
        case 1:
            return firing_.empty() ? climb(anywhere(), nearer) : climb(any(firing_), far);
        default:
            return silent_.empty() ? climb(anywhere(), nearer) : climb(any(silent_), nearer);
        }
    }

    Judge& judge_;
    const Motion& motion_;
    scenes::Random random_;
    std::uint64_t budget_, draws_ = 0;
    double until_; ///< by processorSeconds()
    int idle_ = 0;
    std::vector<Values> meeting_, free_, firing_, silent_;
};

} // namespace

double processorSeconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

Findings attackTable(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, const Table& table,
                     const AttackOptions& options) {
    const Surfaces surfaces(a, b, table.restRegion);
    TableJudge judge(surfaces, motion, table, table.certified || options.boundsAnyway);
    Search(judge, options).run();
    return judge.found;
}

Findings attackProof(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                     const NeverCollides& proof, const AttackOptions& options) {
    const Surfaces surfaces(a, b, proof.restRegion);
    ProofJudge judge(surfaces, motion, proof);
    Search(judge, options).run();
    return judge.found;
}

} // namespace adversary
