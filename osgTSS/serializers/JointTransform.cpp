#include "bake/base/Error.h"
#include "bake/model/SceneModel.h"

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgTSS/JointTransform>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace {

/// A joint, with what it is asked for and what it has, as one line of words: numbers in their shortest form
/// that reads back the same bits (OSG's own text rounds to 6 digits), counts before lists, names after "=".
struct JointText {
    tss::Joint joint; ///< bodies are left out
    std::vector<double> asked, values;
};

class Writer {
public:
    void pass(double value) {
        std::array<char, 32> buffer;
        const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
        word(std::string(buffer.data(), end));
    }
    /// Anything but letters, digits and a few signs as %XX.
    void pass(const std::string& name) {
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
    void pass(tss::DofKind kind) { word(std::to_string(static_cast<int>(kind))); }
    template <class Items, class Each>
    void list(const Items& items, const Each& each) {
        word(std::to_string(items.size()));
        for (const auto& item : items) each(item);
    }
    void expect(bool, const char*, std::size_t) {}

    std::string text;

private:
    void word(const std::string& word) { text += (text.empty() ? "" : " ") + word; }
};

class Reader {
public:
    explicit Reader(const std::string& line) : _words(line) {}

    void pass(double& value) {
        const std::string w = word();
        const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
        if (error != std::errc() || end != w.data() + w.size() || std::isnan(value)) refuse("a number", w);
    }
    void pass(std::string& name) {
        const std::string w = word();
        if (w.empty() || w[0] != '=') refuse("a name after =", w);
        name.clear();
        for (std::size_t i = 1; i < w.size(); ++i) {
            unsigned int code = 0;
            const bool hex = w[i] == '%' && i + 2 < w.size() &&
                             std::from_chars(&w[i + 1], &w[i + 1] + 2, code, 16).ptr == &w[i + 1] + 2;
            name += hex ? static_cast<char>(code) : w[i];
            if (hex) i += 2;
        }
    }
    void pass(tss::DofKind& kind) {
        const std::size_t number = count();
        expect(number <= static_cast<std::size_t>(tss::DofKind::Path), "a kind of DOF", number);
        kind = static_cast<tss::DofKind>(number);
    }
    template <class Items, class Each>
    void list(Items& items, const Each& each) {
        items.resize(count());
        for (auto& item : items) each(item);
    }
    void expect(bool holds, const char* expected, std::size_t found) {
        if (!holds) refuse(expected, std::to_string(found));
    }
    void end() {
        const std::string rest = word();
        if (!rest.empty()) refuse("the end", rest);
    }

private:
    std::size_t count() {
        constexpr double most = 1e6; // a broken line does not allocate
        double value = 0;
        pass(value);
        if (!(value >= 0 && value <= most && value == std::floor(value)))
            refuse("a count", std::to_string(value));
        return static_cast<std::size_t>(value);
    }
    [[noreturn]] static void refuse(const std::string& expected, const std::string& found) {
        throw tss::InputError("joint: expected " + expected + ", found \"" + found + "\"");
    }
    std::string word() {
        std::string w;
        _words >> w;
        return w;
    }
    std::istringstream _words;
};

// What a line holds, in its order, written or read.

template <class Stream, class Numbers>
void passNumbers(Stream& stream, Numbers& numbers) {
    stream.list(numbers, [&](auto& number) { stream.pass(number); });
}

template <class Stream, class Vector>
void passVector(Stream& stream, Vector&& vector) {
    for (Eigen::Index k = 0; k < vector.size(); ++k) stream.pass(vector[k]);
}

template <class Stream, class Pose>
void passPose(Stream& stream, Pose& pose) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) stream.pass(pose.matrix()(row, column));
}

template <class Stream, class Dof>
void passDof(Stream& stream, Dof& dof) {
    stream.pass(dof.name);
    stream.pass(dof.kind);
    passVector(stream, dof.origin);
    passVector(stream, dof.axis);
    for (auto* value : {&dof.lower, &dof.upper, &dof.rest}) stream.pass(*value);
    passPose(stream, dof.frame);
    stream.list(dof.path, [&](auto& row) {
        stream.pass(row.value);
        passVector(stream, row.translation);
        passVector(stream, row.rotation.coeffs());
    });
}

template <class Stream, class Text>
void passText(Stream& stream, Text& text) {
    auto& joint = text.joint;
    stream.pass(joint.path);
    passPose(stream, joint.frame0);
    passPose(stream, joint.frame1);
    stream.list(joint.dofs, [&](auto& dof) { passDof(stream, dof); });
    stream.list(joint.planes, [&](auto& plane) {
        passNumbers(stream, plane.coefficients);
        stream.pass(plane.bound);
        const std::size_t count = plane.coefficients.size();
        stream.expect(count == joint.dofs.size(), "a coefficient a DOF", count);
    });
    stream.list(joint.drives, [&](auto& drive) {
        passNumbers(stream, drive.times);
        passNumbers(stream, drive.values);
        stream.expect(drive.times.size() == drive.values.size(), "a value a time", drive.values.size());
    });
    passNumbers(stream, text.asked);
    passNumbers(stream, text.values);
    stream.expect(text.asked.size() == joint.dofs.size() && text.values.size() == joint.dofs.size(),
                  "a value a DOF", text.values.size());
}

std::string writeJointText(const JointText& text) {
    Writer out;
    passText(out, text);
    return out.text;
}

/// Throws tss::InputError where the line is not one that writeJointText() makes.
JointText readJointText(const std::string& line) {
    Reader in(line);
    JointText text;
    passText(in, text);
    in.end();
    return text;
}

bool checkJoint(const osgTSS::JointTransform&) {
    return true;
}

bool readJoint(osgDB::InputStream& is, osgTSS::JointTransform& node) {
    std::string line;
    is.readWrappedString(line);
    try {
        const JointText text = readJointText(line);
        node.setJoint(text.joint);
        node.setValues(text.asked);
        node.setResolvedValues(text.values);
        return true;
    } catch (const tss::InputError& error) {
        is.throwException(std::string("osgTSS::JointTransform: ") + error.what());
        return false;
    }
}

bool writeJoint(osgDB::OutputStream& os, const osgTSS::JointTransform& node) {
    os.writeWrappedString(writeJointText({node.getJoint(), node.getAskedValues(), node.getValues()}));
    os << std::endl;
    return true;
}

} // namespace

REGISTER_OBJECT_WRAPPER(osgTSS_JointTransform, new osgTSS::JointTransform, osgTSS::JointTransform,
                        "osg::Object osg::Node osg::Group osg::Transform osgTSS::JointTransform") {
    ADD_USER_SERIALIZER(Joint);
}
