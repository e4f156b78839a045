#include "bake/tool/CsvTable.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Words.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/DofUnits.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <sstream>
#include <string_view>

namespace tss::tool {

namespace {

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::string cell;
    std::istringstream stream(line);
    while (std::getline(stream, cell, ',')) {
        const auto blank = [](unsigned char c) { return std::isspace(c) || c == '"'; };
        cell.erase(cell.begin(), std::ranges::find_if_not(cell, blank));
        cell.erase(std::find_if_not(cell.rbegin(), cell.rend(), blank).base(), cell.end());
        cells.push_back(cell);
    }
    if (!line.empty() && line.back() == ',') cells.emplace_back();
    return cells;
}

/// A number that is not finite, as text: in the first line that is a bad value and not the name of a column.
bool isNotFinite(const std::string& cell) {
    const std::string word = lowerCase(cell);
    return word == "nan" || word == "inf" || word == "infinity";
}

/// The number in a cell that has no blanks around it. Throws InputError that begins with `where`.
double cellValue(const std::string& cell, const std::string& where) {
    if (cell.find_first_of("; \t") != cell.npos)
        throw InputError(where + ": expected one finite number, and commas between columns, found \"" + cell +
                         "\"");
    return parseNumber(cell, where);
}

bool isName(const std::string& cell) {
    if (isNotFinite(cell)) return false;
    return cell.empty() || std::isalpha(static_cast<unsigned char>(cell[0])) || cell[0] == '_' ||
           cell[0] == '/';
}

/// Begins text files of some spreadsheets.
constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";

/// Columns for these DOFs, `dofs` being the same ones in the same order. The last name of each, which
/// messages use, is that of the joint where there are several joints, else that of the DOF.
DofColumns columnsFor(const SceneModel& scene, const std::vector<JointDof>& places, std::vector<Dof> dofs) {
    DofColumns columns{std::move(dofs), {}};
    std::map<std::string, int> count;
    const bool several = !places.empty() && places.front().joint != places.back().joint;
    for (const JointDof& place : places) {
        const Joint& joint = scene.joints[place.joint];
        const std::string ofJoint = primName(joint.path), ofDof = joint.dofs[place.dof].name;
        std::vector<std::string>& names = columns.names.emplace_back();
        names = {joint.path + ":" + ofDof, ofJoint + ":" + ofDof};
        if (ofDof == ofJoint)
            names.push_back(ofDof);
        else if (several)
            names.insert(names.end(), {ofDof, ofJoint});
        else
            names.insert(names.end(), {ofJoint, ofDof});
        for (const std::string& name : names) ++count[name];
    }
    // A name that several have is none's; the first, with the whole path, is always unique.
    for (std::vector<std::string>& names : columns.names)
        names.erase(std::remove_if(names.begin() + 1, names.end(),
                                   [&](const std::string& name) { return count[name] > 1; }),
                    names.end());
    return columns;
}

/// For each DOF its column in the file, header.size() where it has none; empty where the header has none of
/// their names. Throws InputError where it has some of them and others, or one twice. expected: the names.
std::vector<std::size_t> orderOf(const std::vector<std::string>& header, const DofColumns& columns,
                                 const std::string& file, const std::string& expected) {
    std::vector<std::size_t> order(columns.dofs.size(), header.size());
    std::size_t unknown = header.size();
    bool any = false;
    for (std::size_t k = 0; k < header.size(); ++k) {
        const std::size_t dof = columnNamed(columns.names, header[k]);
        if (dof == columns.names.size()) {
            unknown = std::min(unknown, k);
            continue;
        }
        std::size_t& column = order[dof];
        if (column < header.size()) throw InputError(Where{file}, "expected one column of " + header[k]);
        column = k;
        any = true;
    }
    if (!any) return {};
    if (unknown < header.size())
        throw InputError(Where{file},
                         fmt::format("\"{}\" is no degree of freedom: expected {}, in any order, or "
                                     "no such line",
                                     header[unknown], expected));
    return order;
}

/// The value, or the limit that it is beyond by no more than rounding: limits and poses are printed with 6
/// digits.
double snappedToLimits(const Dof& dof, double value) {
    const double slack = limitRounding(dof, 5e-6);
    if (value < dof.lower && value >= dof.lower - slack) return dof.lower;
    if (value > dof.upper && value <= dof.upper + slack) return dof.upper;
    return value;
}

} // namespace

CsvTable readCsv(const std::string& file) {
    CsvTable csv;
    std::string text = readWholeFile(file);
    if (text.starts_with(byteOrderMark)) text.erase(0, byteOrderMark.size());
    if (text.find('\n') == text.npos) std::ranges::replace(text, '\r', '\n'); // as old programs end lines
    std::istringstream stream(text);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        const std::size_t first = line.find_first_not_of(" \t");
        if (first == line.npos || line[first] == '#') continue;
        const std::vector<std::string> cells = cellsOf(line);
        if (csv.rows.empty() && csv.header.empty() && std::ranges::all_of(cells, isName)) {
            csv.header = cells;
            continue;
        }
        const std::size_t expected = !csv.header.empty() ? csv.header.size()
                                     : csv.rows.empty()  ? cells.size()
                                                         : csv.rows[0].size();
        if (cells.size() != expected)
            throw InputError(
                fmt::format("{}:{}: expected {} columns, found {}", file, number, expected, cells.size()));
        std::vector<double> row;
        for (std::size_t k = 0; k < cells.size(); ++k)
            row.push_back(cellValue(cells[k], fmt::format("{}:{}: column {}", file, number, k + 1)));
        csv.rows.push_back(std::move(row));
    }
    if (csv.rows.empty()) throw InputError(Where{file}, "expected at least one row of numbers");
    return csv;
}

std::size_t columnNamed(const std::vector<std::vector<std::string>>& names, const std::string& word) {
    for (std::size_t k = 0; k < names.size(); ++k)
        if (std::ranges::find(names[k], word) != names[k].end()) return k;
    std::size_t found = names.size();
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (std::ranges::none_of(names[k],
                                 [&](const auto& name) { return lowerCase(name) == lowerCase(word); }))
            continue;
        if (found < names.size()) return names.size();
        found = k;
    }
    return found;
}

bool isStep(const std::string& word) {
    return lowerCase(word) == "step";
}
bool isTime(const std::string& word) {
    return lowerCase(word) == "time";
}

DofColumns dofColumns(const SceneModel& scene) {
    std::vector<JointDof> places;
    std::vector<Dof> dofs;
    for (std::size_t j = 0; j < scene.joints.size(); ++j)
        for (std::size_t k = 0; k < scene.joints[j].dofs.size(); ++k) {
            places.push_back({static_cast<int>(j), k});
            dofs.push_back(scene.joints[j].dofs[k]);
        }
    return columnsFor(scene, places, std::move(dofs));
}

DofColumns dofColumns(const SceneModel& scene, const Pair& pair) {
    return columnsFor(scene, pairDofs(scene, pair), pairMotion(scene, pair).dofs);
}

DofRows readDofRows(const std::string& file, const DofColumns& columns, bool stepped) {
    CsvTable csv = readCsv(file);
    // A column of times or steps, which is skipped.
    const bool hasTime = stepped && !csv.header.empty() && (isStep(csv.header[0]) || isTime(csv.header[0]));
    std::vector<std::string> expected;
    for (const std::vector<std::string>& names : columns.names) expected.push_back(names.back());
    const std::string words = fmt::format("{}", fmt::join(expected, ", "));
    if (hasTime) csv.header.erase(csv.header.begin());
    const std::vector<std::size_t> order = orderOf(csv.header, columns, file, words);
    std::vector<std::string> missing;
    for (std::size_t k = 0; k < order.size(); ++k)
        if (order[k] == csv.header.size()) missing.push_back(expected[k]);
    if (!missing.empty() && !stepped)
        throw InputError(Where{file}, "expected a column of " + firstOf(missing, 6));
    DofRows read;
    for (std::vector<double>& row : csv.rows) {
        if (hasTime) row.erase(row.begin());
        if (missing.empty() && row.size() != columns.dofs.size())
            throw InputError(Where{file},
                             fmt::format("expected {}, one a degree of freedom ({}), found {}",
                                         counted(columns.dofs.size(), "column"), words, row.size()));
        std::vector<double> values;
        for (std::size_t k = 0; k < columns.dofs.size(); ++k) {
            const Dof& dof = columns.dofs[k];
            const std::size_t column = order.empty() ? k : order[k];
            values.push_back(column < row.size() ? snappedToLimits(dof, fromUser(dof, row[column]))
                                                 : dof.rest);
        }
        read.rows.push_back(std::move(values));
    }
    if (!missing.empty())
        read.remark =
            fmt::format("{}: no column of {}: what has none stays where it rests", file, firstOf(missing, 6));
    if (order.empty() && !csv.header.empty())
        read.remark =
            columns.dofs.size() > 1
                ? fmt::format("{}: its first line has none of the names {}: the columns are taken in that "
                              "order",
                              file, words)
                : fmt::format("{}: its first line is not the name {}: the column is taken for it", file,
                              words);
    return read;
}

} // namespace tss::tool
