#pragma once
#include "bake/pipeline/FillPair.h"
#include "bake/search/AtRest.h"

namespace tss {

/// When spheres of a pair are in contact, with regard to where the joint rests (METHOD 2.4).
struct RuleAtRest {
    ContactRule rule;
    RestRegion region; ///< exempt parts of the meshes as loaded, with the depth of contact at rest
    bool bySpheres =
        false; ///< exempt are spheres that overlap at rest and stand for no known part of the surface
};

/// The rule for spheres from fillPair().
RuleAtRest ruleAtRest(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options);

/// Throws InputError where spheres that are not excepted are no farther apart at rest than epsilon.
void checkRest(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options);

/// Adds notes of what a person should know of contact at rest.
void noteRest(const PairSpheres& spheres, const RuleAtRest& ruled, const Motion& motion,
              const BakeOptions& options, std::vector<std::string>& notes);

} // namespace tss
