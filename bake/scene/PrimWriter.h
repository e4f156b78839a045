#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/model/TimeSamples.h"
#include "bake/scene/Layer.h"
#include "bake/scene/Schema.h"

#include <cstdint>

namespace tss {

/// Sets properties of a prim by the schema. Numbers of float slots are rounded to float. Metadata that a
/// property has already stays.
class PrimWriter {
public:
    explicit PrimWriter(Prim& prim) : prim_(prim) {}

    void set(const Attribute& attribute, Value value);
    /// Leaves the attribute out when the value is the schema's fallback.
    void setUnless(const Attribute& attribute, Value value, const Value& fallback);
    void set(const Attribute& attribute, const std::vector<double>& numbers);
    void set(const Attribute& attribute, const std::vector<std::uint32_t>& numbers);
    void set(const Attribute& attribute, const std::vector<std::string>& texts);
    void set(const Attribute& attribute, const Vec3& vector);
    void set(const Attribute& attribute, const Eigen::Quaterniond& rotation);
    /// An array of vectors.
    void set(const Attribute& attribute, const std::vector<Vec3>& vectors);
    /// Nothing is written when there are none.
    void set(const Attribute& attribute, const TimeSamples& samples);
    void setTargets(const std::string& relationship, const std::vector<std::string>& paths);
    /// Metadata of an attribute that is there, such as its interpolation.
    void setMetadata(const Attribute& attribute, const std::string& key, Value value);
    void remove(const std::string& property) { prim_.properties.erase(property); }

    Prim& prim() { return prim_; }

private:
    Prim& prim_;
};

} // namespace tss
