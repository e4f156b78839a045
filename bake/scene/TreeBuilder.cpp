#include "bake/scene/TreeBuilder.h"

#include "bake/scene/Problems.h"

namespace tss {

namespace {

constexpr std::size_t widestTuple = 16;

/// What a tree may take besides its blocks of numbers, in bytes: an array of empty arrays takes a byte each
/// in a binary file, and 56 in memory. Files of words are well within.
constexpr std::size_t freeMemory = std::size_t(64) << 20, memoryPerByte = 3;
constexpr std::size_t blockSize(std::size_t numbers) {
    return numbers * sizeof(double) + 2 * sizeof(void*);
}
constexpr std::size_t memberSize = sizeof(Value::Object::value_type) + 4 * sizeof(void*);

} // namespace

/// An object or array that is not closed yet. An array holds numbers, tuples of numbers, or as soon as it
/// must, values of any kind.
struct TreeBuilder::Frame {
    enum class Holds { Nothing, Numbers, Tuples, Values };

    bool object = false;
    Value::Object members;
    std::string key;

    Holds holds = Holds::Nothing;
    std::vector<double> numbers;
    std::size_t width = 0;
    Value::Array values;

    std::size_t count() const {
        if (holds == Holds::Values) return values.size();
        return holds == Holds::Tuples ? numbers.size() / width : numbers.size();
    }

    void reset(bool asObject) {
        object = asObject;
        members.clear();
        key.clear();
        holds = Holds::Nothing;
        numbers.clear();
        values.clear();
    }

    void toValues() {
        const double* number = numbers.data();
        for (std::size_t i = 0, n = count(); i < n && holds != Holds::Values; ++i) {
            if (holds == Holds::Numbers)
                values.emplace_back(*number++);
            else
                values.emplace_back(Numbers{std::vector<double>(number, number + width), 0}), number += width;
        }
        numbers.clear();
        holds = Holds::Values;
    }

    Value takeArray() {
        if (holds == Holds::Nothing || holds == Holds::Values) return Value(std::move(values));
        Numbers block{{}, holds == Holds::Tuples ? static_cast<int>(width) : 0};
        if (numbers.size() <= widestTuple)
            block.values.assign(numbers.begin(), numbers.end()); // keep the frame's memory for the next one
        else {
            numbers.shrink_to_fit(); // a large scene is mostly arrays, and grown ones are a third air
            block.values = std::move(numbers);
        }
        return Value(std::move(block));
    }
};

TreeBuilder::TreeBuilder(std::string fileName, std::size_t fileSize)
    : file_(std::move(fileName)), memory_(freeMemory + memoryPerByte * fileSize),
      frames_(new Frame[deepest]) {}
TreeBuilder::~TreeBuilder() = default;

TreeBuilder::Frame& TreeBuilder::top() {
    return frames_[depth_ - 1];
}

bool TreeBuilder::inObject() const {
    return depth_ > 0 && frames_[depth_ - 1].object;
}

void TreeBuilder::spend(std::size_t bytes) {
    if (bytes > memory_)
        refuse("expected fewer values: all but blocks of numbers would take too much memory");
    memory_ -= bytes;
}

void TreeBuilder::refuse(const std::string& message) const {
    Place place;
    for (std::size_t i = 0; i < depth_; ++i) {
        const Frame& frame = frames_[i];
        if (frame.object && frame.key.empty() && i + 1 == depth_) break;
        place = frame.object ? place / frame.key : place / frame.count();
    }
    throw InputError({file_, place.pointer, ""}, message);
}

void TreeBuilder::open(bool object) {
    if (depth_ == deepest) refuse("expected at most " + std::to_string(deepest) + " levels");
    frames_[depth_++].reset(object);
}

void TreeBuilder::put(Value value) {
    if (depth_ == 0) {
        root_ = std::move(value);
        return;
    }
    Frame& frame = top();
    const Numbers* block = value.as<Numbers>();
    spend((frame.object ? memberSize : sizeof(Value)) +
          (block && block->values.size() <= widestTuple ? blockSize(block->values.size()) : 0));
    if (frame.object) {
        frame.members[frame.key] = std::move(value);
        return;
    }
    if (frame.holds != Frame::Holds::Values) {
        const std::size_t each = frame.holds == Frame::Holds::Tuples ? blockSize(frame.width) : 0;
        spend(frame.count() * (sizeof(Value) + each));
        frame.toValues();
    }
    frame.values.push_back(std::move(value));
}

void TreeBuilder::add(double number) {
    if (depth_ == 0 || top().object || top().holds == Frame::Holds::Tuples ||
        top().holds == Frame::Holds::Values)
        return put(Value(number));
    top().holds = Frame::Holds::Numbers;
    top().numbers.push_back(number);
}

void TreeBuilder::add(Value value) {
    const double* number = value.as<double>();
    number ? add(*number) : put(std::move(value));
}

void TreeBuilder::key(const std::string& key) {
    Frame& frame = top();
    frame.key = key;
    if (frame.members.contains(key))
        refuse("expected each key once in an object, found \"" + key + "\" again");
}

bool TreeBuilder::joinedTuples() {
    const Frame& frame = top();
    if (depth_ < 2 || frame.holds != Frame::Holds::Numbers || frame.numbers.size() > widestTuple)
        return false;
    Frame& parent = frames_[depth_ - 2];
    const bool first = parent.holds == Frame::Holds::Nothing;
    const bool fits = parent.holds == Frame::Holds::Tuples && parent.width == frame.numbers.size();
    if (parent.object || !(first || fits)) return false;
    parent.holds = Frame::Holds::Tuples;
    parent.width = frame.numbers.size();
    parent.numbers.insert(parent.numbers.end(), frame.numbers.begin(), frame.numbers.end());
    return true;
}

void TreeBuilder::close() {
    if (joinedTuples()) {
        --depth_;
        return;
    }
    Value value = top().object ? Value(std::move(top().members)) : top().takeArray();
    --depth_;
    put(std::move(value));
}

Value TreeBuilder::take() {
    return std::move(root_);
}

} // namespace tss
