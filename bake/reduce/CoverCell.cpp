#include "bake/reduce/CoverCell.h"

#include "bake/base/Infinity.h"
#include "bake/motion/CellTools.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

bool deeper(const PairInCell& x, const PairInCell& y) {
    return x.gap != y.gap ? x.gap < y.gap : x.contactPair.pair < y.contactPair.pair;
}

/// Guesses where in the cell pair p needs an answer and member k does not give it. With gaps taken as linear
/// in the DOFs, returns the offset from the cell's centre that maximises f = gap of k - weight * gap of p
/// under the constraint gap of p <= `level`. That is a continuous knapsack problem: start at the corner of
/// the cell where f is largest, then move DOFs towards their other end, first those that lower f least for
/// each unit by which they lower the gap of p. As any f > `answer` will do, part of the excess is given up to
/// end inside the constraint rather than on it. k null: the corner where the gap of p is least.
std::array<double, mostCoverDofs> extremeOffset(const CellMotion& motion, const PairInCell* k,
                                                const PairInCell& p, double weight, double level,
                                                double answer) {
    std::array<double, mostCoverDofs> offset{}, price{};
    std::array<std::size_t, mostCoverDofs> flippable{}; // DOFs whose other end has a smaller gap of p
    std::size_t count = 0;
    double gap = p.gap;
    for (std::size_t l = 0; l < motion.dofs(); ++l) {
        const double slope = p.slope[l] / p.distance;
        const double wish = k ? k->slope[l] / k->distance - weight * slope : -slope;
        offset[l] = wish > 0 ? motion.half(l) : -motion.half(l);
        gap += slope * offset[l];
        if (slope * offset[l] <= 0) continue;
        price[l] = std::abs(wish / slope);
        flippable[count++] = l;
    }
    if (!k) return offset;
    std::sort(flippable.begin(), flippable.begin() + count,
              [&](auto x, auto y) { return price[x] < price[y]; });
    const auto flippedUntil = [&](double until) {
        auto moved = offset;
        double left = gap;
        for (std::size_t n = 0; n < count && left > until; ++n) {
            const std::size_t l = flippable[n];
            const double fall = 2 * p.slope[l] / p.distance * offset[l];
            moved[l] *= 1 - 2 * std::min(1.0, (left - until) / fall);
            left -= std::min(fall, left - until);
        }
        return moved;
    };
    // The optimum lies on the boundary of the constraint; aim inside by a part of the excess.
    const auto edge = flippedUntil(level);
    double excess = k->gap - weight * p.gap - answer;
    for (std::size_t l = 0; l < motion.dofs(); ++l)
        excess += (k->slope[l] / k->distance - weight * p.slope[l] / p.distance) * edge[l];
    return excess > 0 ? flippedUntil(level - 0.25 * excess) : edge;
}

} // namespace

OpenCell wholeProblem(const CoverProblem& problem) {
    auto lists = std::make_shared<CellLists>();
    if (!problem.treeA.empty() && !problem.treeB.empty()) lists->nodes.push_back({0, 0});
    return {wholeBox(problem.motion), std::move(lists)};
}

CellVerdict CellExaminer::examine(const OpenCell& whole) {
    OpenCell cell = whole;
    if (!shrinkToPlanes(p_.motion, cell.box)) return {};
    const CellMotion motion(p_.rates, cell.box);
    const auto seen = static_cast<std::uint32_t>(members_.size());
    ++cellNumber_;
    if (collectMembers(motion, *cell.lists)) return {};
    open_.clear();
    for (const ContactPair& pair : cell.lists->open) addIfNear(motion, pair);
    descendNodes(motion, cell.lists->nodes);
    removeAnswered(motion);
    if (open_.empty() && nodes_.empty()) return {};

    if (auto lacking = counterexampleAtCentre(motion)) return {std::move(lacking), {}};
    if (nodes_.empty()) {
        if (auto lacking = counterexampleElsewhere(motion)) return {std::move(lacking), {}};
        double widest = 0;
        for (const PairInCell& pair : open_) widest = std::max(widest, pair.move);
        if (widest < p_.floor || !canSplit(cell.box, widestDof(motion)))
            return {Counterexample{open_.front().contactPair, {}}, {}};
    }
    return split(cell, motion, seen);
}

/// Collects the members that come near in the cell. True: one of them by itself answers all over the cell.
bool CellExaminer::collectMembers(const CellMotion& motion, const CellLists& lists) {
    near_.clear();
    bestMember_ = infinity;
    const auto probe = [&](std::uint32_t k) {
        ++looks_;
        const ContactPair& pair = members_[k];
        const Moved& b = moved(motion, p_.treeB.leafOf(pair.pair.b));
        const double distance = (b.x - p_.a[pair.pair.a].centre).norm();
        if (distance - b.motion.move >
            pair.contactDistance + contract_.margin + contract_.epsilon + p_.band) {
            bestMember_ = std::min(bestMember_, distance - pair.contactDistance);
            return false;
        }
        PairInCell here(motion, b.x, b.motion, p_.a[pair.pair.a].centre, pair);
        here.member = k;
        bestMember_ = std::min(bestMember_, here.gap);
        if (here.staysBelow(pair.contactDistance - contract_.depth + contract_.epsilon, p_.band)) return true;
        if (!here.staysAbove(pair.contactDistance + contract_.margin + contract_.epsilon, p_.band))
            near_.push_back(here);
        return false;
    };
    for (std::uint32_t k : lists.members)
        if (probe(k)) return true;
    for (std::uint32_t k = lists.membersSeen; k < members_.size(); ++k)
        if (probe(k)) return true;
    if (!near_.empty()) std::iter_swap(near_.begin(), std::min_element(near_.begin(), near_.end(), deeper));
    return false;
}

const CellExaminer::Moved& CellExaminer::moved(const CellMotion& motion, std::uint32_t node) {
    Moved& at = moved_[node];
    if (at.cell != cellNumber_) {
        at.cell = cellNumber_;
        at.x = motion.centrePose() * p_.treeB[node].centre;
        at.motion = motion.pointMotion(at.x);
    }
    return at;
}

void CellExaminer::addIfNear(const CellMotion& motion, const ContactPair& pair) {
    ++looks_;
    if (inCover_.contains(pair.pair)) return;
    const Moved& b = moved(motion, p_.treeB.leafOf(pair.pair.b));
    if ((b.x - p_.a[pair.pair.a].centre).norm() - b.motion.move >
        pair.contactDistance + contract_.margin + p_.band)
        return;
    const PairInCell here(motion, b.x, b.motion, p_.a[pair.pair.a].centre, pair);
    if (!here.staysAbove(pair.contactDistance + contract_.margin, p_.band)) open_.push_back(here);
}

/// Descends the trees to the pairs of spheres that come near, and no farther than the motion in the cell
/// allows to tell smaller balls apart.
void CellExaminer::descendNodes(const CellMotion& motion, const std::vector<NodePair>& nodes) {
    nodes_.clear();
    stack_ = nodes;
    descend(p_.treeA, p_.treeB, stack_,
            [&](NodePair pair, const SphereTree::Node& na, const SphereTree::Node& nb) {
                ++looks_;
                if (na.leaf() && nb.leaf()) {
                    if (const auto spheres = p_.requiredPair({na.sphere, nb.sphere}))
                        addIfNear(motion, *spheres);
                    return false;
                }
                const Moved& b = moved(motion, pair.b);
                const double move = b.motion.move, sum = na.radius + nb.radius;
                if ((b.x - na.centre).norm() - move > sum + contract_.margin + p_.band) return false;
                const bool blurred = sum < 2 * move && move > p_.floor;
                if (blurred) nodes_.push_back(pair);
                return !blurred;
            });
}

/// Removes the open pairs that a member dominates, then those that some deeper open pair dominates exactly: a
/// member that answers that one answers them too.
void CellExaminer::removeAnswered(const CellMotion& motion) {
    ranks_.clear();
    for (std::uint32_t k = 0; k < near_.size(); ++k) ranks_.emplace_back(answerRank(near_[k], contract_), k);
    std::sort(ranks_.begin(), ranks_.end());
    std::uint32_t recent = 0; // the member that answered last, likely to answer again
    const auto answered = [&](const PairInCell& p) {
        if (recent < near_.size() && dominates(motion, near_[recent], p, contract_, p_.band)) return true;
        const double needed = rankNeeded(p, contract_);
        for (const auto& [rank, k] : ranks_) {
            if (rank >= needed) break;
            ++looks_;
            if (k != recent && dominates(motion, near_[k], p, contract_, p_.band)) {
                recent = k;
                return true;
            }
        }
        return false;
    };
    std::erase_if(open_, answered);

    ErrorContract exact = contract_;
    exact.epsilon = 0;
    constexpr std::size_t leaders = 4;
    for (std::size_t lead = 0; lead < std::min(leaders, open_.size()); ++lead) {
        const auto place = open_.begin() + lead;
        std::iter_swap(place, std::min_element(place, open_.end(), deeper));
        const PairInCell leader = *place;
        looks_ += open_.size() - lead;
        const auto first = place + 1;
        open_.erase(
            std::remove_if(first, open_.end(),
                           [&](const PairInCell& p) { return dominates(motion, leader, p, exact, p_.band); }),
            open_.end());
    }
}

/// Where the models touch at the centre of the cell and no member answers: the deepest pair there.
std::optional<Counterexample> CellExaminer::counterexampleAtCentre(const CellMotion& motion) const {
    if (bestMember_ <= contract_.answer(-infinity)) return {};
    ContactPair best;
    double gap = infinity;
    if (!open_.empty()) {
        best = open_.front().contactPair;
        gap = open_.front().gap;
    }
    if (!nodes_.empty()) deepestBelow(motion, best, gap);
    if (gap > contract_.margin || bestMember_ <= contract_.answer(gap)) return {};
    if (!withinLimits(p_.motion, motion.centre())) return {};
    return Counterexample{best, {motion.centre().begin(), motion.centre().end()}};
}

/// The same at the poses where an answer is most likely missing: where the deepest open pair has its least
/// gap, and where it just needs an answer and the member that answers there has its largest. Without this, a
/// region without an answer that just overlaps a corner of the cell would be found in the smallest cells
/// only.
std::optional<Counterexample> CellExaminer::counterexampleElsewhere(const CellMotion& motion) const {
    const PairInCell& pair = open_.front();
    const PairInCell* answering = nullptr;
    if (auto found = counterexampleAt(motion, extremeOffset(motion, nullptr, pair, 0, 0, 0), answering))
        return found;
    const double deepEnough = contract_.yesNo() ? 0 : -contract_.depth;
    for (int round = 0; round < 3 && answering; ++round) {
        const PairInCell& member = *answering;
        if (auto found = counterexampleAt(
                motion, extremeOffset(motion, &member, pair, 0, deepEnough, contract_.answer(-infinity)),
                answering))
            return found;
        if (contract_.yesNo()) continue;
        if (auto found = counterexampleAt(
                motion, extremeOffset(motion, &member, pair, 1, contract_.margin, contract_.epsilon),
                answering))
            return found;
    }
    return {};
}

/// A counterexample at an offset from the centre, where there is one. answering: the member with the least
/// gap there, or null.
std::optional<Counterexample> CellExaminer::counterexampleAt(const CellMotion& motion,
                                                             const std::array<double, mostCoverDofs>& offset,
                                                             const PairInCell*& answering) const {
    std::vector<double> q(motion.dofs());
    for (std::size_t k = 0; k < q.size(); ++k)
        q[k] = std::clamp(motion.centre()[k] + offset[k], p_.motion.dofs[k].lower, p_.motion.dofs[k].upper);
    answering = nullptr;
    if (!withinLimits(p_.motion, q)) return {};
    looks_ += near_.size() + open_.size();
    const Pose at = pose(p_.motion, q);
    double member = infinity;
    for (const PairInCell& pair : near_)
        if (const double own = p_.gap(pair.contactPair, at); own < member) {
            member = own;
            answering = &pair;
        }
    ContactPair best;
    double gap = infinity;
    for (const PairInCell& pair : open_)
        if (const double own = p_.gap(pair.contactPair, at); own < gap) {
            gap = own;
            best = pair.contactPair;
        }
    if (gap > contract_.margin || member <= contract_.answer(gap)) return {};
    return Counterexample{best, q};
}

/// The deepest pair at the centre below the nodes not opened, when deeper than the one given.
void CellExaminer::deepestBelow(const CellMotion& motion, ContactPair& best, double& gap) const {
    const double atMost = std::min(gap, std::nextafter(contract_.margin, infinity));
    leastBelow(p_.treeA, p_.treeB, motion.centrePose(), nodes_, atMost,
               [&](std::uint32_t i, std::uint32_t j) {
                   ++looks_;
                   const std::optional<ContactPair> pair = p_.requiredPair({i, j});
                   if (!pair) return infinity;
                   const double own = p_.gap(*pair, motion.centrePose());
                   if (own < gap) {
                       gap = own;
                       best = *pair;
                   }
                   return own;
               });
}

/// The DOF to halve: the one that moves the deepest pair most, or the fastest pair where the deepest moves
/// less than half as far.
std::size_t CellExaminer::widestDof(const CellMotion& motion) const {
    if (open_.empty()) {
        const SphereTree::Node& node = p_.treeB[nodes_.front().b];
        return tss::widestDof(motion, node.centre, node.radius);
    }
    const auto fastest = std::max_element(open_.begin(), open_.end(),
                                          [](const auto& p, const auto& q) { return p.move < q.move; });
    const Vec3 x = open_.front().move >= 0.5 * fastest->move ? open_.front().x : fastest->x;
    const auto share = motion.shares(x);
    return static_cast<std::size_t>(std::max_element(share.begin(), share.begin() + motion.dofs()) -
                                    share.begin());
}

CellVerdict CellExaminer::split(const OpenCell& cell, const CellMotion& motion, std::uint32_t seen) const {
    auto lists = std::make_shared<CellLists>();
    lists->nodes = nodes_;
    lists->open.reserve(open_.size());
    for (const PairInCell& pair : open_) lists->open.push_back(pair.contactPair);
    lists->members.reserve(near_.size());
    for (const PairInCell& pair : near_) lists->members.push_back(pair.member);
    lists->membersSeen = seen;

    const std::size_t widest = widestDof(motion);
    const auto [lower, upper] = splitCell(p_.rates, cell.box, widest);
    return {{}, {{lower, lists}, {upper, lists}}};
}

double CellExaminer::epsilonOver(const OpenCell& whole) {
    OpenCell cell = whole;
    if (!shrinkToPlanes(p_.motion, cell.box)) return 0;
    const CellMotion motion(p_.rates, cell.box);
    ++cellNumber_;
    if (collectMembers(motion, *cell.lists)) return contract_.epsilon;
    double table = infinity;
    for (const ContactPair& pair : members_) {
        const Vec3 x = motion.centrePose() * p_.b[pair.pair.b].centre;
        table = std::min(table, (x - p_.a[pair.pair.a].centre).norm() - pair.contactDistance +
                                    motion.pointMotion(x).move);
    }
    open_.clear();
    for (const ContactPair& pair : cell.lists->open) addIfNear(motion, pair);
    descendNodes(motion, cell.lists->nodes);
    removeAnswered(motion);
    double models = infinity;
    for (const PairInCell& pair : open_) models = std::min(models, pair.gap - pair.move);
    for (const NodePair& pair : nodes_) {
        const SphereTree::Node &na = p_.treeA[pair.a], &nb = p_.treeB[pair.b];
        const Vec3 x = motion.centrePose() * nb.centre;
        models =
            std::min(models, (x - na.centre).norm() - na.radius - nb.radius - motion.pointMotion(x).move);
    }
    models -= p_.band;
    if (models > contract_.margin) return contract_.epsilon;
    return std::max(contract_.epsilon, table - std::max(models, -contract_.depth) + p_.band);
}

} // namespace tss
