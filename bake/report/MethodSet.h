#pragma once
#include "bake/compare/EnclosingTree.h"
#include "bake/compare/Methods.h"
#include "bake/report/Model.h"

#include <string_view>

namespace tss::reporting {

/// A method that the paper or METHOD 7 names and that has no row here, and why.
struct NotRun {
    std::string method, reason;
};

/// The methods that a model is asked with, and those that could not be.
struct MethodSet {
    std::vector<std::shared_ptr<const compare::CollisionMethod>> all;
    std::vector<NotRun> notRun;
};

/// Which methods are made for a model.
enum class MethodScope {
    All,     ///< every method
    Spheres, ///< those whose error depends on the spheres, for a sweep over models
    Table,   ///< the table alone
};

/// The names of all methods, for `only` below, with a blank between.
std::string_view methodNames();

/// Makes the methods for a model. quick: smaller settings of those that take long to build. only: parts of
/// names or families wanted, empty: all. seed: of the sampled ones.
MethodSet makeMethods(const Model& model, MethodScope scope, bool quick, const std::vector<std::string>& only,
                      std::uint64_t seed);

} // namespace tss::reporting
