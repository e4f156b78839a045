#include "bake/base/Error.h"

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

/// Writes such a line, or reads it: the same steps for both.
class Line {
public:
    Line() = default; ///< writes
    explicit Line(const std::string& text) : _reads(true), _words(text) {}

    void pass(double& value) {
        std::array<char, 32> buffer;
        if (!_reads) return write({buffer.data(), std::to_chars(buffer.begin(), buffer.end(), value).ptr});
        const std::string w = read();
        const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
        if (error != std::errc() || end != w.data() + w.size() || std::isnan(value)) refuse("a number", w);
    }
    void pass(std::string& name) {
        if (!_reads) return write(escaped(name));
        const std::string w = read();
        if (w.empty() || w[0] != '=') refuse("a name after =", w);
        name = unescaped(w);
    }
    void pass(tss::DofKind& kind) {
        auto number = static_cast<std::size_t>(kind);
        passCount(number);
        expect(number <= static_cast<std::size_t>(tss::DofKind::Path), "a kind of DOF", number);
        kind = static_cast<tss::DofKind>(number);
    }
    template <class Items, class Each>
    void list(Items& items, const Each& each) {
        std::size_t count = items.size();
        passCount(count);
        items.resize(count);
        for (auto& item : items) each(item);
    }
    void expect(bool holds, const char* expected, std::size_t found) {
        if (!holds) refuse(expected, std::to_string(found));
    }
    void end() {
        const std::string rest = read();
        if (!rest.empty()) refuse("the end", rest);
    }
    std::string text() const { return _words.str(); }

private:
    void passCount(std::size_t& count) {
        constexpr double most = 1e6; // a broken line does not allocate
        auto value = static_cast<double>(count);
        pass(value);
        if (!(value >= 0 && value <= most && value == std::floor(value)))
            refuse("a count", std::to_string(value));
        count = static_cast<std::size_t>(value);
    }
    /// Behind "=", anything but letters, digits and a few signs as %XX.
    static std::string escaped(const std::string& name) {
        std::string text = "=";
        for (unsigned char c : name) {
            std::array<char, 4> hex{static_cast<char>(c)};
            if (!std::isalnum(c) && c != '/' && c != '_' && c != ':' && c != '.')
                std::snprintf(hex.data(), hex.size(), "%%%02X", c);
            text += hex.data();
        }
        return text;
    }
    static std::string unescaped(const std::string& text) {
        std::string name;
        for (std::size_t i = 1; i < text.size(); ++i) {
            unsigned int code = 0;
            const bool hex =
                text[i] == '%' && i + 2 < text.size() &&
                std::from_chars(&text[i + 1], &text[i + 1] + 2, code, 16).ptr == &text[i + 1] + 2;
            name += hex ? static_cast<char>(code) : text[i];
            if (hex) i += 2;
        }
        return name;
    }
    [[noreturn]] static void refuse(const std::string& expected, const std::string& found) {
        throw tss::InputError("joint: expected " + expected + ", found \"" + found + "\"");
    }
    void write(const std::string& word) { _words << (_words.tellp() > 0 ? " " : "") << word; }
    std::string read() {
        std::string word;
        _words >> word;
        return word;
    }

    bool _reads = false;
    std::stringstream _words;
};

void pass(Line& line, std::vector<double>& numbers) {
    line.list(numbers, [&](double& number) { line.pass(number); });
}

template <class Vector>
void passVector(Line& line, Vector&& vector) {
    for (Eigen::Index k = 0; k < vector.size(); ++k) line.pass(vector[k]);
}

void pass(Line& line, tss::Pose& pose) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) line.pass(pose.matrix()(row, column));
}

void pass(Line& line, tss::Dof& dof) {
    line.pass(dof.name);
    line.pass(dof.kind);
    passVector(line, dof.origin);
    passVector(line, dof.axis);
    for (double* value : {&dof.lower, &dof.upper, &dof.rest}) line.pass(*value);
    pass(line, dof.frame);
    line.list(dof.path, [&](tss::PathRow& row) {
        line.pass(row.value);
        passVector(line, row.translation);
        passVector(line, row.rotation.coeffs());
    });
}

void pass(Line& line, JointText& text) {
    tss::Joint& joint = text.joint;
    line.pass(joint.path);
    pass(line, joint.frame0);
    pass(line, joint.frame1);
    line.list(joint.dofs, [&](tss::Dof& dof) { pass(line, dof); });
    line.list(joint.planes, [&](tss::LimitPlane& plane) {
        pass(line, plane.coefficients);
        line.pass(plane.bound);
        const std::size_t count = plane.coefficients.size();
        line.expect(count == joint.dofs.size(), "a coefficient a DOF", count);
    });
    line.list(joint.drives, [&](tss::TimeSamples& drive) {
        pass(line, drive.times);
        pass(line, drive.values);
        line.expect(drive.times.size() == drive.values.size(), "a value a time", drive.values.size());
    });
    pass(line, text.asked);
    pass(line, text.values);
    line.expect(text.asked.size() == joint.dofs.size() && text.values.size() == joint.dofs.size(),
                "a value a DOF", text.values.size());
}

bool checkJoint(const osgTSS::JointTransform&) {
    return true;
}

bool readJoint(osgDB::InputStream& is, osgTSS::JointTransform& node) {
    std::string words;
    is.readWrappedString(words);
    try {
        Line line(words);
        JointText text;
        pass(line, text);
        line.end();
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
    Line line;
    JointText text{node.getJoint(), node.getAskedValues(), node.getValues()};
    pass(line, text);
    os.writeWrappedString(line.text());
    os << std::endl;
    return true;
}

} // namespace

REGISTER_OBJECT_WRAPPER(osgTSS_JointTransform, new osgTSS::JointTransform, osgTSS::JointTransform,
                        "osg::Object osg::Node osg::Group osg::Transform osgTSS::JointTransform") {
    ADD_USER_SERIALIZER(Joint);
}
