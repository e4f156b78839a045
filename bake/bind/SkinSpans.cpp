#include "bake/bind/SkinSpans.h"

#include "bake/base/Parallel.h"

#include <algorithm>

namespace tss {
namespace {

/// #frames + 1 of #V: shares, those of what holds still last.
using Shares = std::vector<std::vector<double>>;

class SpanFollower {
public:
    SpanFollower(const SkinAnatomy& anatomy, const SkinParameters& parameters, SkinAttachment& attachment)
        : anatomy_(anatomy), parameters_(parameters), attachment_(attachment),
          frameOf_(framesOf(anatomy, parameters)), own_(attachment.frames), still_(own_.size()) {
        own_.emplace_back(anatomy.skin.vertices.size(), 1);
        for (std::size_t f = 0; f < still_; ++f)
            for (std::size_t v = 0; v < own_[f].size(); ++v) own_[still_][v] -= own_[f][v];
        wanted_ = own_;
    }

    void run() {
        bool any = false;
        for (std::size_t m = 0; m < anatomy_.bodies.size(); ++m) any = follow(m) || any;
        if (!any) return;
        parallelFor(own_[0].size(), [&](std::size_t v) { giveWay(v); });
        wanted_.pop_back();
        attachment_.frames = std::move(wanted_);
        // A tether is in the shares already.
        unfoldShares(anatomy_.skin, anatomy_.graph, anatomy_.length,
                     {endMotions(parameters_, frameOf_, still_), {}}, attachment_.frames);
    }

private:
    const Pose& poseOf(const std::vector<Pose>& station, std::size_t body) const {
        static const Pose rest = Pose::Identity();
        return body < station.size() ? station[body] : rest;
    }

    /// Whether two bodies never move against each other; body #bodies holds still.
    bool moveAsOne(std::size_t a, std::size_t b) const {
        for (const BoneSwing& swing : parameters_.swings)
            for (const std::vector<Pose>& station : swing)
                if (poseOf(station, a).matrix() != poseOf(station, b).matrix()) return false;
        return true;
    }

    /// The frames, and what holds still, that move as a body does.
    std::vector<std::size_t> framesAs(std::size_t body) const {
        std::vector<std::size_t> found;
        for (std::size_t f = 0; f <= still_; ++f) {
            const auto first =
                static_cast<std::size_t>(std::ranges::find(frameOf_, static_cast<int>(f)) - frameOf_.begin());
            if ((f == still_ || first < frameOf_.size()) && moveAsOne(first, body)) found.push_back(f);
        }
        return found;
    }

    /// Changes the shares that one vertex has of some frames, of each in proportion to what it has.
    void shift(std::size_t v, double change, const std::vector<std::size_t>& to) {
        double sum = 0;
        for (const std::size_t f : to) sum += own_[f][v];
        for (const std::size_t f : to)
            wanted_[f][v] += sum > 0 ? change * own_[f][v] / sum : f == to.front() ? change : 0;
    }

    /// The bones of a muscle that move by themselves, as skin has shares of them.
    struct Bones {
        std::vector<std::vector<std::size_t>> frames;      ///< of each the frames that move as it does
        std::vector<std::pair<double, std::size_t>> stops; ///< places along the chain, rising, and whose
    };

    Bones bonesOf(std::size_t m) const {
        const std::span<const int> chain = chainOf(parameters_, m);
        Bones bones;
        for (std::size_t k = 0; k <= chain.size(); ++k) {
            std::vector<std::size_t> frames = framesAs(k == 0 ? m : static_cast<std::size_t>(chain[k - 1]));
            if (frames.empty()) continue; // skin has no share of it
            const auto known = std::ranges::find(bones.frames, frames) - bones.frames.begin();
            if (known == std::ssize(bones.frames)) bones.frames.push_back(std::move(frames));
            bones.stops.emplace_back(static_cast<double>(k) / static_cast<double>(chain.size()), known);
        }
        return bones;
    }

    /// How much of each of the bones what lies at a place along them has.
    static std::vector<double> sharesAt(const Bones& bones, double place) {
        std::vector<double> shares(bones.frames.size(), 0);
        std::size_t k = 1;
        while (k + 1 < bones.stops.size() && bones.stops[k].first < place) ++k;
        const auto& [before, a] = bones.stops[k - 1];
        const auto& [after, b] = bones.stops[k];
        const double t = std::clamp((place - before) / (after - before), 0.0, 1.0);
        shares[a] += 1 - t;
        shares[b] += t;
        return shares;
    }

    /// Adds what a muscle wants of the skin on it. Returns whether it is one over several bones.
    bool follow(std::size_t m) {
        const std::vector<double>& hold = attachment_.muscles[m];
        const std::vector<double>& along = anatomy_.bodies[m]->chainShares();
        if (chainOf(parameters_, m).empty() || hold.empty() || along.empty() || parameters_.swings.empty())
            return false;
        const Bones bones = bonesOf(m);
        if (bones.frames.size() < 2) return false;
        const std::vector<Tri>& triangles = anatomy_.bodies[m]->muscle().surface.triangles;
        for (std::size_t v = 0; v < hold.size(); ++v) {
            if (!(hold[v] > 0)) continue;
            const NearestPoint& near = attachment_.bindings[m][v];
            double place = 0, sum = 0;
            for (int k = 0; k < 3; ++k) place += near.weights[k] * along[triangles[near.triangle][k]];
            std::vector<double> has(bones.frames.size(), 0);
            for (std::size_t k = 0; k < has.size(); ++k) {
                for (const std::size_t f : bones.frames[k]) has[k] += own_[f][v];
                sum += has[k];
            }
            const std::vector<double> wanted = sharesAt(bones, place);
            for (std::size_t k = 0; k < has.size(); ++k)
                shift(v, hold[v] * (sum * wanted[k] - has[k]), bones.frames[k]);
        }
        return true;
    }

    Pose blended(const Shares& shares, std::size_t v, const std::vector<Pose>& station) const {
        PoseBlend blend;
        std::vector<char> taken(still_, 0);
        for (std::size_t m = 0; m < frameOf_.size(); ++m) {
            if (frameOf_[m] < 0 || taken[frameOf_[m]]) continue;
            taken[frameOf_[m]] = 1;
            if (const double share = shares[frameOf_[m]][v]; share > 0)
                blend.add(share, DualPose(station[m]));
        }
        return blend.pose();
    }

    /// Leaves as much of what is wanted of a vertex as brings it within reach of contact.
    void giveWay(std::size_t v) {
        bool same = true;
        for (std::size_t f = 0; f <= still_; ++f) same = same && wanted_[f][v] == own_[f][v];
        if (same) return;
        const Vec3& x = anatomy_.skin.vertices[v];
        double off = 0;
        for (const BoneSwing& swing : parameters_.swings)
            for (const std::vector<Pose>& station : swing)
                off =
                    std::max(off, (blended(wanted_, v, station) * x - blended(own_, v, station) * x).norm());
        const double part = off > anatomy_.length ? 1 - anatomy_.length / off : 0;
        for (std::size_t f = 0; f <= still_; ++f)
            wanted_[f][v] = std::clamp(own_[f][v] + part * (wanted_[f][v] - own_[f][v]), 0.0, 1.0);
    }

    const SkinAnatomy& anatomy_;
    const SkinParameters& parameters_;
    SkinAttachment& attachment_;
    std::vector<int> frameOf_; ///< #bodies
    Shares own_, wanted_;      ///< by the skin's own shares; as muscles want it
    std::size_t still_;        ///< the last of these
};

} // namespace

void followSpans(const SkinAnatomy& anatomy, const SkinParameters& parameters, SkinAttachment& attachment) {
    if (!attachment.frames.empty()) SpanFollower(anatomy, parameters, attachment).run();
}

} // namespace tss
