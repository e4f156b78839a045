#include "bake/base/Order.h"
#include "bake/verify/MeshProof.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace tss::verify {

namespace {

/// Beyond so many pieces of a surface, or pairs of pieces looked at, nothing is told apart; of pairs that are
/// left at most so many are listed.
constexpr std::size_t mostPieces = 500'000, mostPairs = 20'000'000, mostLeft = 1000;
constexpr std::size_t mostHolders = 8; ///< of a piece, that are listed
constexpr double finest = 5e-3;        ///< of the radius of a ball near a piece: no smaller ones are made

/// The spheres of one body that tests have, by their place in the list.
struct Balls {
    std::vector<Sphere> spheres;
    std::map<std::uint32_t, std::uint32_t> place; ///< of a sphere's number in the table

    std::uint32_t add(std::uint32_t number, const Vec3& centre, double radius) {
        const auto found = place.try_emplace(number, std::uint32_t(spheres.size()));
        if (found.second) spheres.push_back({centre, radius});
        return found.first->second;
    }
};

/// A piece of a surface and the balls that hold it.
struct Held {
    Piece piece;
    bool exempt;
    std::vector<std::uint32_t> holders; ///< balls that contain it
};

/// One surface cut into pieces, each as large as some ball contains it.
class HeldPieces {
public:
    HeldPieces(const SurfaceTree& tree, const std::vector<Sphere>& balls, std::vector<char> full)
        : tree_(tree), shapes_(tree), balls_(balls), full_(std::move(full)), of_(balls.size()),
          alike_(tree.nodes.size(), 1) {
        for (std::size_t k = 0; k < alike_.size(); ++k) {
            const auto first = std::size_t(tree.nodes[k].first), second = std::size_t(tree.nodes[k].second);
            if (tree.nodes[k].first >= 0)
                alike_[k] =
                    alike_[first] && alike_[second] && tree.nodes[first].exempt == tree.nodes[second].exempt;
        }
        std::vector<std::uint32_t> all = indicesOf(balls.size());
        visit({tree.root(), 1}, all);
    }

    /// The pieces of which the ball is the first holder.
    const std::vector<Held>& of(std::uint32_t ball) const { return of_[ball]; }
    const std::vector<Piece>& bare() const { return bare_; } ///< what no ball contains
    bool tooMany() const { return pieces_ > mostPieces || bare_.size() > mostPieces / 10; }

private:
    static bool contains(const Sphere& ball, const Shape& shape) {
        if (!shape.corners) return shape.slab.farthest(ball.centre) <= ball.radius;
        return std::ranges::all_of(
            *shape.corners, [&](const Vec3& corner) { return (corner - ball.centre).norm() <= ball.radius; });
    }

    /// Puts the piece where it belongs, or its halves. near: the balls that may reach it.
    void visit(Piece piece, const std::vector<std::uint32_t>& near) {
        if (tooMany()) return;
        const Shape shape = shapes_.of(piece);
        const auto node = std::size_t(piece.node);
        std::vector<std::uint32_t> reaching;
        Held best{piece, tree_.nodes[node].exempt, {}}, any = best;
        double largest = 0; // of those that may hold all that is not exempt
        for (const std::uint32_t k : near) {
            const Sphere& ball = balls_[k];
            if ((ball.centre - shape.slab.centre).norm() > ball.radius + shape.slab.reach) continue;
            reaching.push_back(k);
            if (best.exempt || full_[k]) largest = std::max(largest, ball.radius);
            if (!alike_[node] || !contains(ball, shape)) continue;
            if ((best.exempt || full_[k]) && best.holders.size() < mostHolders) best.holders.push_back(k);
            if (any.holders.size() < mostHolders) any.holders.push_back(k);
        }
        ++pieces_;
        // What is not exempt is best held by balls that are asked with all of the other body (`full_`), and
        // is halved down to a size to find such; else any ball will do, and where there is none it is bare.
        const bool ends = !divisible(tree_, piece) || reaching.empty();
        if (!best.holders.empty())
            of_[best.holders.front()].push_back(std::move(best));
        else if (!any.holders.empty() && (ends || shape.slab.reach <= finest * largest || largest == 0))
            of_[any.holders.front()].push_back(std::move(any));
        else if (ends || shape.slab.reach <= finest * balls_[reaching.front()].radius)
            bare_.push_back(piece);
        else
            for (std::uint32_t side = 0; side < 2; ++side) visit(half(tree_, piece, side), reaching);
    }

    const SurfaceTree& tree_;
    PieceShapes shapes_;
    const std::vector<Sphere>& balls_;
    const std::vector<char> full_; ///< each ball: it may hold what is not exempt
    std::vector<std::vector<Held>> of_;
    std::vector<Piece> bare_;
    std::vector<char> alike_; ///< each node: what is below is all exempt, or nothing of it is
    std::size_t pieces_ = 0;
};

/// The pairs of balls of A and B that are a test which fires wherever the two meet.
class FiringTests {
public:
    explicit FiringTests(const MeshClaim& claim) {
        std::vector<std::array<std::uint32_t, 2>> pairs;
        for (const MeshTest& t : claim.tests) {
            const std::uint32_t i = a.add(t.sphereA, t.centreA, t.radiusA);
            const std::uint32_t j = b.add(t.sphereB, t.centreB, t.radiusB);
            if (t.radiusA + t.radiusB + claim.near <= t.contactDistance + claim.miss + 0.5 * claim.band)
                pairs.push_back({i, j});
        }
        if (10 * pairs.size() < 9 * a.spheres.size() * b.spheres.size()) return;
        fires_.assign(a.spheres.size() * b.spheres.size(), 0);
        for (const auto& [i, j] : pairs) fires_[i * b.spheres.size() + j] = 1;
    }

    bool nearlyAll() const { return !fires_.empty(); }
    bool has(std::uint32_t i, std::uint32_t j) const { return fires_[i * b.spheres.size() + j]; }
    bool has(const Held& x, const Held& y) const {
        return std::ranges::any_of(x.holders, [&](std::uint32_t i) {
            return std::ranges::any_of(y.holders, [&](std::uint32_t j) { return has(i, j); });
        });
    }

    /// For each ball of A, or of B, whether it is asked with all balls of the other body; all of them where
    /// none is.
    std::vector<char> full(bool ofB) const {
        const std::size_t count = ofB ? b.spheres.size() : a.spheres.size();
        const std::size_t others = ofB ? a.spheres.size() : b.spheres.size();
        std::vector<char> full(count, 1);
        for (std::uint32_t k = 0; k < count; ++k)
            for (std::uint32_t o = 0; o < others; ++o) full[k] = full[k] && (ofB ? has(o, k) : has(k, o));
        if (std::ranges::count(full, char{1}) == 0) full.assign(count, 1);
        return full;
    }

    Balls a, b;

private:
    std::vector<char> fires_;
};

/// Pairs of pieces that are left to be shown; where there are many, pairs of the larger pieces that those are
/// parts of.
class LeftPairs {
public:
    LeftPairs(const SurfaceTree& a, const SurfaceTree& b) : aboveA_(parents(a)), aboveB_(parents(b)) {}

    void add(Piece a, Piece b) {
        for (int k = 0; k < up_; ++k) {
            a = larger(a, aboveA_);
            b = larger(b, aboveB_);
        }
        pairs_.insert({std::uint32_t(a.node), a.cuts, std::uint32_t(b.node), b.cuts});
        if (pairs_.size() > mostKept) coarsen();
    }
    std::vector<PiecePair> few() {
        while (pairs_.size() > mostLeft) coarsen();
        std::vector<PiecePair> list;
        for (const auto& [a, cutsA, b, cutsB] : pairs_)
            list.push_back({{std::int32_t(a), cutsA}, {std::int32_t(b), cutsB}});
        return list;
    }

private:
    static std::vector<std::int32_t> parents(const SurfaceTree& tree) {
        std::vector<std::int32_t> above(tree.nodes.size(), tree.root());
        for (std::size_t k = 0; k < tree.nodes.size(); ++k)
            for (const std::int32_t child : {tree.nodes[k].first, tree.nodes[k].second})
                if (child >= 0) above[std::size_t(child)] = std::int32_t(k);
        return above;
    }
    static Piece larger(const Piece& piece, const std::vector<std::int32_t>& above) {
        return piece.cuts > 1 ? Piece{piece.node, piece.cuts >> 1} : Piece{above[std::size_t(piece.node)], 1};
    }
    void coarsen() {
        const auto before = std::exchange(pairs_, {});
        ++up_;
        for (const auto& [a, cutsA, b, cutsB] : before) {
            const Piece x = larger({std::int32_t(a), cutsA}, aboveA_),
                        y = larger({std::int32_t(b), cutsB}, aboveB_);
            pairs_.insert({std::uint32_t(x.node), x.cuts, std::uint32_t(y.node), y.cuts});
        }
    }

    static constexpr std::size_t mostKept = 50'000;
    const std::vector<std::int32_t> aboveA_, aboveB_;
    std::set<std::array<std::uint32_t, 4>> pairs_;
    int up_ = 0; ///< how many levels up the pieces of pairs are taken
};

} // namespace

std::optional<std::vector<PiecePair>> pairsNotHeld(const SurfaceTree& a, const SurfaceTree& b,
                                                   const MeshClaim& claim) {
    const FiringTests firing(claim);
    if (!firing.nearlyAll()) return std::nullopt;
    const HeldPieces ofA(a, firing.a.spheres, firing.full(false)),
        ofB(b, firing.b.spheres, firing.full(true));
    if (ofA.tooMany() || ofB.tooMany()) return std::nullopt;
    LeftPairs left(a, b);
    for (const Piece& bare : ofA.bare()) left.add(bare, {b.root(), 1});
    for (const Piece& bare : ofB.bare()) left.add({a.root(), 1}, bare);
    std::size_t looked = 0;
    for (std::uint32_t i = 0; i < firing.a.spheres.size(); ++i)
        for (std::uint32_t j = 0; j < firing.b.spheres.size(); ++j) {
            if (firing.has(i, j)) continue;
            looked += ofA.of(i).size() * ofB.of(j).size();
            if (looked > mostPairs) return std::nullopt;
            for (const Held& x : ofA.of(i))
                for (const Held& y : ofB.of(j))
                    if (!(x.exempt && y.exempt) && !firing.has(x, y)) left.add(x.piece, y.piece);
        }
    return left.few();
}

} // namespace tss::verify
