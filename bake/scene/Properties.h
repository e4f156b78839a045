#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/model/SceneModel.h"
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"
#include "bake/scene/Schema.h"

#include <functional>
#include <optional>

namespace tss {

/// Reads one prim's properties by the schema. What is wrong goes to the problems, and the fallback is
/// returned: that of the schema for an attribute that is absent.
class PrimReader {
public:
    PrimReader(const Prim& prim, Place place, Problems& problems)
        : prim_(prim), place_(std::move(place)), problems_(problems) {}

    const Prim& prim() const { return prim_; }
    const Place& place() const { return place_; }
    Place placeOf(const Attribute& attribute, std::string_view field = "") const;
    template <class... Parts>
    void problem(const Attribute& attribute, const Parts&... parts) const {
        if (prim_.property(attribute.name))
            problems_.add(valuePlace(attribute), parts...);
        else
            problems_.add(place_, attribute.name, ": ", parts...);
    }
    template <class... Parts>
    void problem(const Parts&... parts) const {
        problems_.add(place_, parts...);
    }
    /// A problem with the targets of a relationship.
    template <class... Parts>
    void targetProblem(const Attribute& relationship, const Parts&... parts) const {
        problems_.add(placeOf(relationship, "targetPaths"), parts...);
    }

    bool has(const Attribute& attribute) const { return prim_.property(attribute.name) != nullptr; }

    /// Default, or the first time sample where there is no default; null when absent or blocked.
    const Value* value(const Attribute& attribute) const;

    double real(const Attribute& attribute, double fallback) const;
    /// As real(), and also -inf or inf: a limit that is none.
    double limit(const Attribute& attribute, double fallback) const;
    std::uint64_t count(const Attribute& attribute, std::uint64_t fallback) const;
    bool flag(const Attribute& attribute, bool fallback) const;
    std::string text(const Attribute& attribute, const std::string& fallback = "") const;
    /// One of the attribute's choices, the first of which is the fallback.
    std::string choice(const Attribute& attribute) const;
    std::vector<std::string> texts(const Attribute& attribute) const;
    Vec3 vector(const Attribute& attribute, const Vec3& fallback) const;
    Eigen::Quaterniond rotation(const Attribute& attribute) const;
    /// All numbers of an array, finite and in the attribute's range; tuples one after the other.
    std::vector<double> reals(const Attribute& attribute) const;
    /// The same, of which there must be this many where the attribute is present; empty when not.
    std::vector<double> reals(const Attribute& attribute, std::size_t count) const;
    std::vector<Vec3> vectors(const Attribute& attribute) const;
    /// Whole numbers from 0 to 2^31 - 1.
    std::vector<std::uint32_t> indices(const Attribute& attribute) const;
    /// The time samples, or the default as the only one.
    TimeSamples samples(const Attribute& attribute) const;

    /// Paths that a relationship names; empty when it is absent.
    std::vector<std::string> targets(const Attribute& relationship) const;
    /// The one path that it names, empty when it is absent or names none.
    std::string target(const Attribute& relationship) const;

private:
    const Property* find(const Attribute& attribute) const;
    Place valuePlace(const Attribute& attribute) const;
    template <class T>
    const T* single(const Attribute& attribute) const;

    const Prim& prim_;
    Place place_;
    Problems& problems_;
};

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
    /// The items, or no attribute when there are none.
    template <class Items>
    void setIfAny(const Attribute& attribute, const Items& items) {
        items.empty() ? remove(attribute) : set(attribute, items);
    }
    void setTargets(const Attribute& relationship, const std::vector<std::string>& paths);
    /// Metadata of an attribute that is there, such as its interpolation.
    void setMetadata(const Attribute& attribute, const std::string& key, Value value);
    void remove(const Attribute& property) { prim_.properties.erase(std::string(property.name)); }

    Prim& prim() { return prim_; }

private:
    Prim& prim_;
};

/// An attribute that is a member of a T: how it is read and written. Those that ask for more than that, such
/// as other attributes, have neither and are read and written by hand.
template <class T>
struct Field {
    Field(const Attribute& attribute) : attribute(attribute) {}
    template <class Read, class Write>
    Field(const Attribute& attribute, Read read, Write write)
        : attribute(attribute), read(std::move(read)), write(std::move(write)) {}

    Attribute attribute;
    std::function<void(const PrimReader&, const Attribute&, T&)> read;
    std::function<void(PrimWriter&, const Attribute&, const T&)> write; ///< what is absent is left out
};

/// All attributes of a schema type.
template <class T>
struct Fields : std::vector<Field<T>> {
    using std::vector<Field<T>>::vector;

    void read(const PrimReader& prim, T& to) const {
        for (const Field<T>& field : *this)
            if (field.read) field.read(prim, field.attribute, to);
    }
    void write(PrimWriter& prim, const T& from) const {
        for (const Field<T>& field : *this)
            if (field.write) field.write(prim, field.attribute, from);
    }
    SchemaType schema(std::string_view name) const {
        SchemaType type{name, {}};
        for (const Field<T>& field : *this) type.attributes.push_back(field.attribute);
        return type;
    }
};

/// A number, flag or text; of a number that may not be known a negative one says so too.
template <class T, class Member>
Field<T> field(std::string_view declaration, Member T::*member, const std::type_identity_t<Member>& fallback,
               Range range, std::string_view meaning) {
    const auto read = [=](const PrimReader& prim, const Attribute& attribute, T& to) {
        if constexpr (std::is_same_v<Member, std::optional<double>>) {
            const double number = prim.real(attribute, -1);
            to.*member = number < 0 ? std::nullopt : std::optional(number);
        } else if constexpr (std::is_same_v<Member, double>)
            to.*member = prim.real(attribute, fallback);
        else if constexpr (std::is_same_v<Member, bool>)
            to.*member = prim.flag(attribute, fallback);
        else if constexpr (std::is_same_v<Member, std::string>)
            to.*member = prim.text(attribute, fallback);
        else
            to.*member = prim.count(attribute, fallback);
    };
    const auto write = [=](PrimWriter& prim, const Attribute& attribute, const T& from) {
        if constexpr (std::is_same_v<Member, std::optional<double>>)
            from.*member ? prim.set(attribute, Value(*(from.*member))) : prim.remove(attribute);
        else
            prim.setUnless(attribute, Value(from.*member), Value(fallback));
    };
    return {declared(declaration, meaning, range), read, write};
}

} // namespace tss
