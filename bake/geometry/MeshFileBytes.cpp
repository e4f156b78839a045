#include "bake/geometry/MeshFileParts.h"

#include "bake/base/Subprocess.h"

#include <cstring>

namespace tss {

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Tri) == 3 * sizeof(int));

class Writer {
public:
    template <class T>
    void number(const T& value) {
        raw(&value, sizeof value);
    }
    void text(const std::string& value) {
        number(value.size());
        raw(value.data(), value.size());
    }
    template <class T>
    void triples(const std::vector<T>& values) {
        number(values.size());
        raw(values.data(), values.size() * sizeof(T));
    }

    std::string bytes;

private:
    void raw(const void* from, std::size_t count) {
        if (count > 0) bytes.append(static_cast<const char*>(from), count);
    }
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}

    template <class T>
    T number() {
        T value;
        raw(&value, sizeof value);
        return value;
    }
    std::string text() {
        const auto size = number<std::size_t>();
        expect(size);
        std::string value(left_.substr(0, size));
        left_.remove_prefix(size);
        return value;
    }
    template <class T>
    std::vector<T> triples() {
        const auto count = number<std::size_t>();
        expect(count);
        std::vector<T> values(count);
        if (count > 0) raw(values.data()->data(), count * sizeof(T));
        return values;
    }

private:
    void expect(std::size_t count) const {
        if (count > left_.size()) throw SubprocessFailed("cut short");
    }
    void raw(void* to, std::size_t count) {
        expect(count);
        std::memcpy(to, left_.data(), count);
        left_.remove_prefix(count);
    }

    std::string_view left_;
};

} // namespace

std::string bytesOf(const MeshFile& file) {
    Writer to;
    const MeshFileNotes& notes = file.notes;
    to.number(notes.leftOut.size());
    for (const std::string& text : notes.leftOut) to.text(text);
    to.number(notes.metersPerUnit);
    to.number(notes.upAxis);
    to.number(notes.step);
    to.number(file.nodes.size());
    for (const ImportedNode& node : file.nodes) {
        to.text(node.name);
        for (int k = 0; k < 16; ++k) to.number(node.place.matrix().data()[k]);
        to.triples(node.mesh.vertices);
        to.triples(node.mesh.triangles);
    }
    return std::move(to.bytes);
}

MeshFile meshFileOf(std::string_view bytes) {
    Reader from(bytes);
    MeshFile file;
    for (auto left = from.number<std::size_t>(); left > 0; --left) file.notes.leftOut.push_back(from.text());
    file.notes.metersPerUnit = from.number<double>();
    file.notes.upAxis = from.number<char>();
    file.notes.step = from.number<double>();
    for (auto left = from.number<std::size_t>(); left > 0; --left) {
        ImportedNode& node = file.nodes.emplace_back();
        node.name = from.text();
        for (int k = 0; k < 16; ++k) node.place.matrix().data()[k] = from.number<double>();
        node.mesh.vertices = from.triples<Vec3>();
        node.mesh.triangles = from.triples<Tri>();
    }
    return file;
}

} // namespace tss
