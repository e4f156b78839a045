// UsdSkel of OpenUSD: what its schemas' documentation says of Skeleton and SkelAnimation.
#include "bake/usd/UsdSkeleton.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr Attribute jointsOf{"joints", "token[]", true};

void addNumbers(const Value& value, std::vector<double>& numbers) {
    if (const auto* block = value.as<Numbers>())
        numbers.insert(numbers.end(), block->values.begin(), block->values.end());
    else if (const auto* array = value.as<Value::Array>())
        for (const Value& item : *array) addNumbers(item, numbers);
    else if (const auto* number = value.as<double>())
        numbers.push_back(*number);
    else
        throw InputError("expected numbers, found " + describe(value));
}

/// The parent of each joint: the nearest one above it in its path that is a joint.
std::vector<int> parentsOf(const PrimReader& prim, const std::vector<std::string>& joints) {
    std::map<std::string, int> at;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (!at.emplace(joints[j], static_cast<int>(j)).second)
            prim.problem(jointsOf, "expected each joint once, found \"", joints[j], "\" again");
    std::vector<int> parents;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        auto found = at.end();
        for (std::string above = joints[j]; found == at.end() && above.find('/') != above.npos;) {
            above.resize(above.rfind('/'));
            found = at.find(above);
        }
        parents.push_back(found != at.end() ? found->second : -1);
        if (parents.back() > static_cast<int>(j))
            prim.problem(jointsOf, "expected each joint behind its parent, found \"", joints[j],
                         "\" before \"", found->first, "\"");
    }
    return parents;
}

/// One a joint; none where the attribute is absent.
std::vector<Eigen::Affine3d> matricesOf(const PrimReader& prim, const char* name, std::size_t count) {
    std::vector<Eigen::Affine3d> matrices;
    const Attribute attribute{name, "matrix4d[]", true};
    const Value* value = prim.value(attribute);
    if (!value) return matrices;
    const std::vector<double> numbers = numbersIn(*value);
    if (numbers.size() != 16 * count)
        prim.problem(attribute, "expected ", count, " matrices, one a joint, found ", numbers.size() / 16);
    for (std::size_t j = 0; 16 * (j + 1) <= numbers.size(); ++j)
        matrices.push_back(affineOf(&numbers[16 * j]));
    return matrices;
}

} // namespace

std::vector<double> numbersIn(const Value& value) {
    std::vector<double> numbers;
    addNumbers(value, numbers);
    for (const double number : numbers)
        if (!std::isfinite(number)) throw InputError("expected finite numbers, found " + numberText(number));
    return numbers;
}

Eigen::Affine3d affineOf(const double* numbers) {
    Eigen::Affine3d affine;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) affine.matrix()(column, row) = numbers[4 * row + column];
    constexpr double rounded = 1e-6;
    const Eigen::RowVector4d last = affine.matrix().row(3);
    if (!(last - Eigen::RowVector4d(0, 0, 0, 1)).isZero(rounded))
        throw InputError("expected matrices that end in a column of 0, 0, 0, 1");
    affine.makeAffine();
    return affine;
}

std::map<std::string, int> UsdSkeleton::indices() const {
    std::map<std::string, int> indices;
    for (std::size_t j = 0; j < joints.size(); ++j) indices.emplace(joints[j], static_cast<int>(j));
    return indices;
}

std::vector<Eigen::Affine3d> UsdSkeleton::composed(const std::vector<Eigen::Affine3d>& local) const {
    std::vector<Eigen::Affine3d> places;
    for (std::size_t j = 0; j < local.size(); ++j)
        places.push_back(parents[j] < 0 ? local[j] : places[parents[j]] * local[j]);
    return places;
}

UsdSkeleton readUsdSkeleton(const PrimReader& prim) {
    UsdSkeleton skeleton;
    skeleton.joints = prim.texts(jointsOf);
    const std::size_t count = skeleton.joints.size();
    if (count == 0) prim.problem("expected joints, found none");
    skeleton.parents = parentsOf(prim, skeleton.joints);
    skeleton.bound = matricesOf(prim, "bindTransforms", count);
    skeleton.rest = matricesOf(prim, "restTransforms", count);
    if (skeleton.bound.empty())
        prim.problem("expected bindTransforms, where the meshes are bound to the joints");
    for (const Eigen::Affine3d& bound : skeleton.bound)
        if (!(std::abs(bound.linear().determinant()) > 0))
            prim.problem("expected bindTransforms that can be inverted");
    for (std::size_t j = 0; j < count && skeleton.rest.size() < count; ++j) {
        const int parent = skeleton.parents[j];
        skeleton.rest.push_back(parent < 0 ? skeleton.bound[j]
                                           : skeleton.bound[parent].inverse() * skeleton.bound[j]);
    }
    return skeleton;
}

UsdAnimation::UsdAnimation(const PrimReader& prim, const UsdSkeleton& skeleton) : skeleton_(skeleton) {
    const std::map<std::string, int> known = skeleton.indices();
    for (const std::string& joint : prim.texts(jointsOf)) {
        const auto found = known.find(joint);
        jointOf_.push_back(found != known.end() ? found->second : -1);
        if (found == known.end()) unknown_.push_back(joint);
    }
    translations_ = samplesOf(prim, "translations", 3);
    rotations_ = samplesOf(prim, "rotations", 4);
    scales_ = samplesOf(prim, "scales", 3);
}

UsdAnimation::Samples UsdAnimation::samplesOf(const PrimReader& prim, const char* name,
                                              std::size_t width) const {
    Samples samples;
    const Property* property = prim.prim().property(name);
    if (!property) return samples;
    const auto add = [&](const Value& value) {
        samples.values.push_back(numbersIn(value));
        if (samples.values.back().size() != width * jointOf_.size())
            throw InputError(joined(name, ": expected ", jointOf_.size(), " values, one a joint, found ",
                                    samples.values.back().size() / width));
    };
    for (const Property::Sample& sample : property->timeSamples) {
        if (sample.value.isNull()) continue;
        samples.times.push_back(sample.time);
        add(sample.value);
    }
    if (samples.values.empty() && property->defaultValue && !property->defaultValue->isNull())
        add(*property->defaultValue);
    return samples;
}

std::vector<double> UsdAnimation::times() const {
    std::vector<double> times;
    for (const Samples* samples : {&translations_, &rotations_, &scales_})
        times.insert(times.end(), samples->times.begin(), samples->times.end());
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

std::vector<double> UsdAnimation::at(const Samples& samples, double time, bool turns) {
    const auto next = std::ranges::upper_bound(samples.times, time);
    const auto k = static_cast<std::size_t>(next - samples.times.begin());
    if (k == 0) return samples.values.front();
    if (k == samples.times.size()) return samples.values.back();
    const double t = (time - samples.times[k - 1]) / (samples.times[k] - samples.times[k - 1]);
    std::vector<double> values = samples.values[k - 1];
    const std::vector<double>& after = samples.values[k];
    for (std::size_t i = 0; !turns && i < values.size(); ++i) values[i] += t * (after[i] - values[i]);
    for (std::size_t i = 0; turns && i + 3 < values.size(); i += 4) {
        const auto turnIn = [&](const std::vector<double>& of) {
            return Eigen::Quaterniond(of[i], of[i + 1], of[i + 2], of[i + 3]);
        };
        const Eigen::Quaterniond turn = turnIn(values).slerp(t, turnIn(after));
        values[i] = turn.w(), values[i + 1] = turn.x(), values[i + 2] = turn.y(), values[i + 3] = turn.z();
    }
    return values;
}

std::vector<Eigen::Affine3d> UsdAnimation::localAt(double time) const {
    std::vector<Eigen::Affine3d> local = skeleton_.rest;
    std::vector<double> translations, rotations, scales;
    if (translations_.any()) translations = at(translations_, time, false);
    if (rotations_.any()) rotations = at(rotations_, time, true);
    if (scales_.any()) scales = at(scales_, time, false);
    for (std::size_t k = 0; k < jointOf_.size(); ++k) {
        if (jointOf_[k] < 0) continue;
        Eigen::Affine3d& place = local[jointOf_[k]];
        if (rotations_.any()) {
            Eigen::Quaterniond turn(rotations[4 * k], rotations[4 * k + 1], rotations[4 * k + 2],
                                    rotations[4 * k + 3]);
            turn = turn.norm() > 0 ? turn.normalized() : Eigen::Quaterniond::Identity();
            place.linear() = turn.toRotationMatrix();
        }
        if (scales_.any()) place.linear() = place.linear() * Vec3::Map(&scales[3 * k]).asDiagonal();
        if (translations_.any()) place.translation() = Vec3::Map(&translations[3 * k]);
    }
    return local;
}

} // namespace tss
