#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/model/TimeSamples.h"
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"
#include "bake/scene/Schema.h"

#include <initializer_list>
#include <limits>

namespace tss {

/// Numbers that a slot accepts; infinite ends are open, not-finite numbers are never in a range.
struct Range {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
};

/// Reads one prim's properties by the schema. What is wrong goes to the problems, and the fallback is
/// returned: that of the schema for an attribute that is absent.
class PrimReader {
public:
    PrimReader(const Prim& prim, Place place, Problems& problems)
        : prim_(prim), place_(std::move(place)), problems_(problems) {}

    const Prim& prim() const { return prim_; }
    const Place& place() const { return place_; }
    Place placeOf(const std::string& property, const char* field = "") const;
    void problem(const Attribute& attribute, const std::string& message) const;
    void problem(const std::string& message) const { problems_.add(place_, message); }

    bool has(const Attribute& attribute) const { return prim_.property(attribute.name) != nullptr; }

    /// Default, or the first time sample where there is no default; null when absent or blocked.
    const Value* value(const Attribute& attribute) const;

    double real(const Attribute& attribute, double fallback, Range range = {}) const;
    /// As real(), and also -inf or inf: a limit that is none.
    double limit(const Attribute& attribute, double fallback) const;
    std::uint64_t count(const Attribute& attribute, std::uint64_t fallback = 0) const;
    bool flag(const Attribute& attribute, bool fallback) const;
    std::string text(const Attribute& attribute, const std::string& fallback) const;
    /// One of the tokens allowed, the first of which is the fallback.
    std::string choice(const Attribute& attribute, std::initializer_list<const char*> allowed) const;
    std::vector<std::string> texts(const Attribute& attribute) const;
    Vec3 vector(const Attribute& attribute, const Vec3& fallback) const;
    Eigen::Quaterniond rotation(const Attribute& attribute) const;
    /// All numbers of an array, finite and in the range; tuples one after the other.
    std::vector<double> reals(const Attribute& attribute, Range range = {}) const;
    /// As reals(); a problem when it is there and has another number of numbers.
    std::vector<double> reals(const Attribute& attribute, std::size_t count, Range range = {}) const;
    std::vector<Vec3> vectors(const Attribute& attribute) const;
    std::vector<std::uint32_t> indices(const Attribute& attribute) const;
    /// Time samples, or the default as one sample at time 0.
    TimeSamples samples(const Attribute& attribute) const;

    /// Paths that a relationship names; empty when it is absent.
    std::vector<std::string> targets(const std::string& relationship) const;
    /// The one path that it names, empty when it is absent or names none.
    std::string target(const std::string& relationship) const;

private:
    const Property* find(const Attribute& attribute) const;
    Place valuePlace(const Attribute& attribute) const;
    template <class T>
    const T* single(const Attribute& attribute) const;

    const Prim& prim_;
    Place place_;
    Problems& problems_;
};

} // namespace tss
