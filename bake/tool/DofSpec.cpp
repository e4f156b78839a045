#include "bake/tool/DofSpec.h"

#include "bake/base/Error.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/tool/CsvTable.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace tss::tool {

namespace {

Vec3 parseAxis(const std::string& text, const std::string& what) {
    Vec3 axis = parseVector(text, what);
    if (!(axis.norm() > 0))
        throw InputError(what + ": expected an axis that is not zero, found \"" + text + "\"");
    return axis;
}

double limitOf(const std::string& text, const std::string& what, double metersPerUnit, double axisLength) {
    const bool unit = !text.empty() && std::isalpha(static_cast<unsigned char>(text.back()));
    if (!unit) return parseNumber(text, what);
    try {
        return parseLength(text, metersPerUnit) / axisLength;
    } catch (const InputError& error) {
        throw InputError(what + ": " + error.message);
    }
}

/// Throws InputError where a header has names of path columns in another order than they are read in.
void checkPathHeader(const std::vector<std::string>& header, const std::string& file) {
    const std::vector<std::vector<std::string>> names = {{""},   {"tx"}, {"ty"}, {"tz"},
                                                         {"rx"}, {"ry"}, {"rz"}};
    for (std::size_t k = 0; k < header.size(); ++k)
        if (const std::size_t place = columnNamed(names, header[k]);
            place > 0 && place < names.size() && place != k)
            throw InputError(Where{file}, fmt::format("column {} is called {}; expected the order "
                                                      "value,tx,ty,tz, and for rotation rx,ry,rz",
                                                      k + 1, header[k]));
}

/// Throws InputError where the rows give no pose at some value from lower to upper.
void checkCover(const std::vector<PathRow>& rows, double lower, double upper, const std::string& file) {
    for (std::size_t k = 1; k < rows.size(); ++k)
        if (!(rows[k - 1].value < rows[k].value))
            throw InputError(Where{file}, fmt::format("expected values that rise, found {:.9g} after {:.9g}",
                                                      rows[k].value, rows[k - 1].value));
    if (lower < rows.front().value || upper > rows.back().value)
        throw InputError(Where{file}, fmt::format("its values go from {:.9g} to {:.9g}; expected rows that "
                                                  "cover the limits {:.9g} to {:.9g}",
                                                  rows.front().value, rows.back().value, lower, upper));
}

std::vector<PathRow> readPath(const std::string& file) {
    const CsvTable csv = readCsv(file);
    checkPathHeader(csv.header, file);
    std::vector<PathRow> rows;
    for (const auto& row : csv.rows) {
        if (row.size() != 4 && row.size() != 7)
            throw InputError(
                Where{file},
                "expected 4 or 7 columns: value,tx,ty,tz, and for rotation rx,ry,rz, an axis times degrees");
        PathRow path;
        path.value = row[0];
        path.translation = Vec3(row[1], row[2], row[3]);
        const Vec3 turn =
            row.size() == 7 ? Vec3(toRadians(1) * Vec3(row[4], row[5], row[6])) : Vec3(Vec3::Zero());
        if (turn.norm() > 0)
            path.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
        rows.push_back(path);
    }
    return rows;
}

std::string describePath(const Dof& dof) {
    double most = 0; // between two rows, radians
    for (std::size_t k = 1; k < dof.path.size(); ++k)
        most = std::max(most, dof.path[k - 1].rotation.angularDistance(dof.path[k].rotation));
    const auto turns = [](const PathRow& row) { return row.rotation.vec().norm() > 0; };
    if (!std::ranges::any_of(dof.path, turns)) return fmt::format(" ({} rows, no rotation)", dof.path.size());
    return fmt::format(" ({} rows, with rotation, by at most {:.3g} degrees from row to row)",
                       dof.path.size(), toDegrees(most));
}

} // namespace

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

std::vector<double> parseNumbers(const std::string& text, const std::string& what) {
    std::vector<double> numbers;
    for (const std::string& part : split(text, ',')) numbers.push_back(parseNumber(part, what));
    return numbers;
}

Vec3 parseVector(const std::string& text, const std::string& what) {
    const std::vector<double> numbers = parseNumbers(text, what);
    if (numbers.size() != 3) throw InputError(what + ": expected x,y,z, found \"" + text + "\"");
    return {numbers[0], numbers[1], numbers[2]};
}

Dof parseDof(const std::string& text, double metersPerUnit) {
    const std::string what = "--dof " + text;
    const std::vector<std::string> parts = split(text, ':');
    const std::string kind = parts.empty() ? "" : parts[0];
    Dof dof;
    if (kind == "rot" && parts.size() == 5) {
        dof.kind = DofKind::Rotation;
        dof.origin = parseVector(parts[1], what);
        dof.axis = parseAxis(parts[2], what).normalized();
        dof.lower = toRadians(parseNumber(parts[3], what));
        dof.upper = toRadians(parseNumber(parts[4], what));
    } else if (kind == "trans" && parts.size() == 4) {
        dof.kind = DofKind::Translation;
        dof.axis = parseAxis(parts[1], what);
        dof.lower = limitOf(parts[2], what, metersPerUnit, dof.axis.norm());
        dof.upper = limitOf(parts[3], what, metersPerUnit, dof.axis.norm());
    } else if (kind == "path" && parts.size() == 4) {
        dof.kind = DofKind::Path;
        dof.path = readPath(parts[1]);
        dof.lower = parseNumber(parts[2], what);
        dof.upper = parseNumber(parts[3], what);
        checkCover(dof.path, dof.lower, dof.upper, parts[1]);
    } else {
        throw InputError(what + ": expected rot:ORIGIN:AXIS:LO:HI, trans:AXIS:LO:HI or path:FILE.csv:LO:HI");
    }
    dof.name = kind;
    if (dof.lower > dof.upper) throw InputError(what + ": expected LO <= HI");
    return dof;
}

std::vector<Dof> parseDofs(const std::vector<std::string>& texts, double metersPerUnit) {
    std::vector<Dof> dofs;
    for (const std::string& text : texts) dofs.push_back(parseDof(text, metersPerUnit));
    std::map<std::string, int> ofKind, soFar;
    for (const Dof& dof : dofs) ++ofKind[dof.name];
    for (Dof& dof : dofs)
        if (ofKind[dof.name] > 1) dof.name += std::to_string(++soFar[dof.name]);
    return dofs;
}

bool isParsedName(const std::string& name) {
    const std::string kind = name.substr(0, name.find_first_of("123456789"));
    return (kind == "rot" || kind == "trans" || kind == "path") &&
           name.find_first_not_of("0123456789", kind.size()) == name.npos;
}

double parseUnit(const std::string& text, const std::string& option) {
    double metres = 0;
    try {
        metres = parseLength(text, 1);
    } catch (const InputError&) {
    }
    if (!(metres > 0 && std::isfinite(metres)))
        throw InputError(option + ": expected a number > 0 or a length such as 1mm, found \"" + text + "\"");
    return metres;
}

std::string describeDofs(const Motion& motion, double metersPerUnit) {
    std::string text;
    for (const Dof& dof : motion.dofs) {
        std::string unit;
        if (dof.kind == DofKind::Rotation) unit = " degrees";
        if (dof.kind == DofKind::Translation) unit = " times " + lengthText(dof.axis.norm(), metersPerUnit);
        text += fmt::format("{}{} {:.6g} to {:.6g}{}, rest {:.6g}{}", text.empty() ? "" : "; ", dof.name,
                            toUser(dof, dof.lower) + 0.0, toUser(dof, dof.upper) + 0.0, unit,
                            toUser(dof, dof.rest) + 0.0, // no "-0"
                            dof.kind == DofKind::Path ? describePath(dof) : "");
    }
    return text;
}

} // namespace tss::tool
