#pragma once
#include "bake/motion/Motion.h"

#include <string>
#include <vector>

namespace tss::tool {

/// Rows of numbers, each with the same number of columns.
struct CsvTable {
    std::vector<std::string> header; ///< empty when the file has none
    std::vector<std::vector<double>> rows;
};

/// Reads a CSV file of finite numbers: an optional first line of names, empty lines and lines starting with #
/// skipped. columns > 0: each row must have so many. Throws InputError with file, line and column.
CsvTable readCsv(const std::string& file, std::size_t columns = 0);

/// A first line that names a DOF in another one's column is not what the columns are taken for: throws
/// InputError. Names of its own are the writer's affair. first: the column of dofs[0].
void checkColumns(const CsvTable& csv, const std::vector<Dof>& dofs, const std::string& file,
                  std::size_t first = 0);

/// Poses from a CSV file, one column a DOF: a row each, in the DOFs' own units.
std::vector<std::vector<double>> readPoses(const std::string& file, const std::vector<Dof>& dofs);

} // namespace tss::tool
