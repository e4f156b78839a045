#include "bake/tool/CsvTable.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <sstream>

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

/// What reads as no number though it stands for one: in a first line, that is a bad value and no header.
bool isNotFinite(std::string cell) {
    std::ranges::transform(cell, cell.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return cell == "nan" || cell == "inf" || cell == "infinity";
}

bool isName(const std::string& cell) {
    if (isNotFinite(cell)) return false;
    return cell.empty() || std::isalpha(static_cast<unsigned char>(cell[0])) || cell[0] == '_' ||
           cell[0] == '/';
}

} // namespace

CsvTable readCsv(const std::string& file, std::size_t columns) {
    CsvTable csv;
    std::istringstream stream(readWholeFile(file));
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.find_first_not_of(" \t") == std::string::npos || line[0] == '#') continue;
        const std::vector<std::string> cells = cellsOf(line);
        if (csv.rows.empty() && csv.header.empty() && std::ranges::all_of(cells, isName)) {
            csv.header = cells;
            continue;
        }
        const std::size_t expected = columns ? columns : csv.rows.empty() ? cells.size() : csv.rows[0].size();
        if (cells.size() != expected)
            throw InputError(
                fmt::format("{}:{}: expected {} columns, found {}", file, number, expected, cells.size()));
        std::vector<double> row;
        for (std::size_t k = 0; k < cells.size(); ++k)
            row.push_back(parseNumber(cells[k], fmt::format("{}:{}: column {}", file, number, k + 1)));
        csv.rows.push_back(std::move(row));
    }
    return csv;
}

void checkColumns(const CsvTable& csv, const std::vector<Dof>& dofs, const std::string& file,
                  std::size_t first) {
    for (std::size_t k = 0; k < dofs.size() && first + k < csv.header.size(); ++k) {
        const std::string& found = csv.header[first + k];
        if (found != dofs[k].name && std::ranges::find(dofs, found, &Dof::name) != dofs.end())
            throw InputError(Where{file}, "column " + std::to_string(first + k + 1) +
                                              ": expected the degree of freedom \"" + dofs[k].name +
                                              "\", found \"" + found + "\"");
    }
}

std::vector<std::vector<double>> readPoses(const std::string& file, const std::vector<Dof>& dofs) {
    CsvTable csv = readCsv(file, dofs.size());
    checkColumns(csv, dofs, file);
    for (std::vector<double>& row : csv.rows) row = fromUser(dofs, row);
    return csv.rows;
}

} // namespace tss::tool
