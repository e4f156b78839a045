#pragma once
#include "bake/check/VerifyPair.h"
#include "tests/adversary/judge/Attack.h"
#include "tests/adversary/scenes/Scene.h"

#include <map>
#include <string>

namespace adversary {

struct TrialOptions {
    std::uint64_t poses = 1000;
    double bakeSeconds = 5;     ///< of processor time, after which the bake is asked to stop
    double verifySeconds = 20;  ///< the same for the proof
    double attackSeconds = 1e9; ///< the same for the attack, which judges a tenth of the poses in any case
};

/// One scene baked, written, read, proven again and attacked.
struct Trial {
    std::string name;
    std::string refusal;  ///< of the bake; empty: baked
    bool stopped = false; ///< the bake's or the proof's time was over: not finished, and not judged by it
    bool proof = false, certified = false, missUnknown = false;
    std::string verifyRefusal; ///< empty: holds
    std::size_t tests = 0;
    double exemptShare = 0; ///< the larger of the two shares of the surfaces that the claims leave out
    bool firesAtRest = false;
    double bakeTook = 0, verifyTook = 0, attackTook = 0; ///< seconds of processor time
    Findings found;
    std::vector<std::string> troubles; ///< what must never be, in words
};

/// The pair of a scene with its bake; never throws for what is refused.
Trial tryScene(tss::SceneModel scene, const std::string& name, std::uint64_t seed,
               const TrialOptions& options);

/// What the generators draw for a seed.
Trial tryScene(std::uint64_t seed, const TrialOptions& options);

/// Claims of a scene that has its table or proof already, attacked.
Findings attackPair(const tss::SceneModel& scene, const tss::Pair& pair, const AttackOptions& options);

/// Sums over trials.
struct Tally {
    int scenes = 0, refused = 0, stopped = 0, proofs = 0, tables = 0, uncertified = 0, missUnknown = 0,
        vacuous = 0, firesAtRest = 0, verifyRefused = 0, verified = 0, troubles = 0;
    std::uint64_t poses = 0, contacts = 0, missed = 0, early = 0, kernel = 0, doubts = 0;
    double bakeTook = 0, verifyTook = 0, attackTook = 0, share = 0;
};
void add(Tally& tally, const Trial& trial);

/// By kind, with a last row of sums; then how often which refusal was.
class Tallies {
public:
    void add(const std::string& kind, const Trial& trial);
    const Tally& all() const { return all_; }
    std::string text() const;

private:
    std::map<std::string, Tally> kinds_;
    std::map<std::string, int> refusals_, verifyRefusals_;
    Tally all_;
};

} // namespace adversary
