#pragma once
#include "bake/scene/Value.h"

#include <memory>

namespace tss {

/// Makes a Value from the events of a parser, JSON or CBOR alike, and refuses on the way what neither library
/// looks at: a key twice in one object, more than 64 levels, more values on their own than a file of that
/// size can mean. Every refusal is an InputError with the JSON pointer of the place.
class TreeBuilder {
public:
    static constexpr std::size_t deepest = 64;

    /// fileSize: in bytes, which bounds the memory.
    TreeBuilder(std::string fileName, std::size_t fileSize);
    ~TreeBuilder();

    void add(Value value);
    void add(double number);
    void open(bool object);
    void key(const std::string& key);
    void close();

    /// What is open is an object.
    bool inObject() const;

    [[noreturn]] void refuse(const std::string& message) const;

    /// The finished tree.
    Value take();

private:
    struct Frame;
    Frame& top();
    /// As it is, wherever it stands.
    void put(Value value);
    /// Whether what is closed is a tuple of numbers that the array around it takes in.
    bool joinedTuples();
    void spend(std::size_t bytes);

    std::string file_;
    std::size_t memory_;              ///< bytes that values which are not in blocks of numbers may still take
    std::unique_ptr<Frame[]> frames_; ///< kept and reused, so that a million triples do not allocate
    std::size_t depth_ = 0;
    Value root_;
};

} // namespace tss
