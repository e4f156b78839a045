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
        unfoldShares(anatomy_.skin, anatomy_.graph, anatomy_.length, foldingMotions(), attachment_.frames);
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

    /// Moves shares of one vertex from some frames to others, of each as much as it has of them together.
    void shift(std::size_t v, double change, const std::vector<std::size_t>& to) {
        double sum = 0;
        for (const std::size_t f : to) sum += own_[f][v];
        for (const std::size_t f : to)
            wanted_[f][v] += sum > 0 ? change * own_[f][v] / sum : f == to.front() ? change : 0;
    }

    /// Adds what a muscle wants of the skin on it. Returns whether it is one between two bones.
    bool follow(std::size_t m) {
        const int insertion = insertionOf(parameters_, m);
        const std::vector<double>& hold = attachment_.muscles[m];
        const std::vector<double>& shares = anatomy_.bodies[m]->insertionShares();
        if (insertion < 0 || hold.empty() || shares.empty() || parameters_.swings.empty()) return false;
        const auto origin = framesAs(m), end = framesAs(static_cast<std::size_t>(insertion));
        if (origin.empty() || end.empty() || origin == end) return false;
        const std::vector<Tri>& triangles = anatomy_.bodies[m]->muscle().surface.triangles;
        for (std::size_t v = 0; v < hold.size(); ++v) {
            if (!(hold[v] > 0)) continue;
            const NearestPoint& near = attachment_.bindings[m][v];
            double share = 0, atOrigin = 0, atEnd = 0;
            for (int k = 0; k < 3; ++k) share += near.weights[k] * shares[triangles[near.triangle][k]];
            for (const std::size_t f : origin) atOrigin += own_[f][v];
            for (const std::size_t f : end) atEnd += own_[f][v];
            const double change = hold[v] * ((atOrigin + atEnd) * share - atEnd);
            shift(v, -change, origin);
            shift(v, change, end);
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

    ShareOptions foldingMotions() const {
        ShareOptions options; // a tether is in the shares already
        for (const BoneSwing& swing : parameters_.swings) {
            if (swing.empty()) continue;
            std::vector<DualPose>& motion = options.motions.emplace_back(still_);
            for (std::size_t m = 0; m < frameOf_.size(); ++m)
                if (frameOf_[m] >= 0) motion[frameOf_[m]] = DualPose(swing.back()[m]);
        }
        return options;
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
