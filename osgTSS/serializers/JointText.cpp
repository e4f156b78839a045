#include "JointText.h"

#include "bake/base/Error.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace {

using tss::Dof;
using tss::Pose;
using tss::Vec3;

class Writer {
public:
    void number(double value) {
        std::array<char, 32> buffer;
        const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
        word(std::string(buffer.data(), end));
    }
    void count(std::size_t value) { word(std::to_string(value)); }
    void numbers(const std::vector<double>& values) {
        count(values.size());
        for (double value : values) number(value);
    }
    void vector(const Vec3& v) {
        for (int k = 0; k < 3; ++k) number(v[k]);
    }
    void pose(const Pose& pose) {
        for (int column = 0; column < 4; ++column) vector(pose.matrix().col(column).head<3>());
    }
    /// Anything but letters, digits and a few signs as %XX.
    void name(const std::string& name) {
        std::string escaped = "=";
        for (unsigned char c : name) {
            if (std::isalnum(c) || c == '/' || c == '_' || c == ':' || c == '.') {
                escaped += static_cast<char>(c);
            } else {
                std::array<char, 4> hex;
                std::snprintf(hex.data(), hex.size(), "%%%02X", c);
                escaped += hex.data();
            }
        }
        word(escaped);
    }

    std::string text;

private:
    void word(const std::string& word) { text += (text.empty() ? "" : " ") + word; }
};

class Reader {
public:
    explicit Reader(const std::string& line) : _words(line) {}

    double number() {
        const std::string w = word();
        double value = 0;
        const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
        if (error != std::errc() || end != w.data() + w.size() || std::isnan(value)) refuse("a number", w);
        return value;
    }
    std::size_t count() {
        constexpr double most = 1e6; // a broken line does not allocate
        const double value = number();
        if (!(value >= 0 && value <= most && value == std::floor(value)))
            refuse("a count", std::to_string(value));
        return static_cast<std::size_t>(value);
    }
    std::vector<double> numbers() {
        std::vector<double> values(count());
        for (double& value : values) value = number();
        return values;
    }
    Vec3 vector() {
        Vec3 v;
        for (int k = 0; k < 3; ++k) v[k] = number();
        return v;
    }
    Pose pose() {
        Pose pose = Pose::Identity();
        for (int column = 0; column < 4; ++column) pose.matrix().col(column).head<3>() = vector();
        return pose;
    }
    std::string name() {
        const std::string w = word();
        if (w.empty() || w[0] != '=') refuse("a name after =", w);
        std::string name;
        for (std::size_t i = 1; i < w.size(); ++i) {
            unsigned int code = 0;
            const bool hex = w[i] == '%' && i + 2 < w.size() &&
                             std::from_chars(&w[i + 1], &w[i + 1] + 2, code, 16).ptr == &w[i + 1] + 2;
            name += hex ? static_cast<char>(code) : w[i];
            if (hex) i += 2;
        }
        return name;
    }
    void end() {
        std::string rest;
        if (_words >> rest) refuse("the end", rest);
    }
    [[noreturn]] static void refuse(const std::string& expected, const std::string& found) {
        throw tss::InputError("joint: expected " + expected + ", found \"" + found + "\"");
    }

private:
    std::string word() {
        std::string w;
        _words >> w;
        return w;
    }
    std::istringstream _words;
};

void write(Writer& out, const Dof& dof) {
    out.name(dof.name);
    out.count(static_cast<std::size_t>(dof.kind));
    out.vector(dof.origin);
    out.vector(dof.axis);
    for (double value : {dof.lower, dof.upper, dof.rest}) out.number(value);
    out.pose(dof.frame);
    out.count(dof.path.size());
    for (const tss::PathRow& row : dof.path) {
        out.number(row.value);
        out.vector(row.translation);
        for (int k = 0; k < 4; ++k) out.number(row.rotation.coeffs()[k]);
    }
}

Dof readDof(Reader& in) {
    Dof dof;
    dof.name = in.name();
    const std::size_t kind = in.count();
    if (kind > static_cast<std::size_t>(tss::DofKind::Path))
        Reader::refuse("a kind of DOF", std::to_string(kind));
    dof.kind = static_cast<tss::DofKind>(kind);
    dof.origin = in.vector();
    dof.axis = in.vector();
    dof.lower = in.number();
    dof.upper = in.number();
    dof.rest = in.number();
    dof.frame = in.pose();
    dof.path.resize(in.count());
    for (tss::PathRow& row : dof.path) {
        row.value = in.number();
        row.translation = in.vector();
        for (int k = 0; k < 4; ++k) row.rotation.coeffs()[k] = in.number();
    }
    return dof;
}

} // namespace

std::string writeJointText(const JointText& text) {
    Writer out;
    const tss::Joint& joint = text.joint;
    out.name(joint.path);
    out.pose(joint.frame0);
    out.pose(joint.frame1);
    out.count(joint.dofs.size());
    for (const Dof& dof : joint.dofs) write(out, dof);
    out.count(joint.planes.size());
    for (const tss::LimitPlane& plane : joint.planes) {
        out.numbers(plane.coefficients);
        out.number(plane.bound);
    }
    out.count(joint.drives.size());
    for (const tss::TimeSamples& drive : joint.drives) {
        out.numbers(drive.times);
        out.numbers(drive.values);
    }
    out.numbers(text.asked);
    out.numbers(text.values);
    return out.text;
}

JointText readJointText(const std::string& line) {
    Reader in(line);
    JointText text;
    tss::Joint& joint = text.joint;
    joint.path = in.name();
    joint.frame0 = in.pose();
    joint.frame1 = in.pose();
    joint.dofs.resize(in.count());
    for (Dof& dof : joint.dofs) dof = readDof(in);
    joint.planes.resize(in.count());
    for (tss::LimitPlane& plane : joint.planes) {
        plane.coefficients = in.numbers();
        plane.bound = in.number();
        if (plane.coefficients.size() != joint.dofs.size())
            Reader::refuse("a coefficient a DOF", std::to_string(plane.coefficients.size()));
    }
    joint.drives.resize(in.count());
    for (tss::TimeSamples& drive : joint.drives) {
        drive.times = in.numbers();
        drive.values = in.numbers();
        if (drive.times.size() != drive.values.size())
            Reader::refuse("a value a time", std::to_string(drive.values.size()));
    }
    text.asked = in.numbers();
    text.values = in.numbers();
    if (text.asked.size() != joint.dofs.size() || text.values.size() != joint.dofs.size())
        Reader::refuse("a value a DOF", std::to_string(text.values.size()));
    in.end();
    return text;
}
