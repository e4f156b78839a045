#pragma once
#include "bake/model/SceneModel.h"

#include <string>
#include <vector>

namespace tss::tool {

/// Rows of numbers, each with the same number of columns.
struct CsvTable {
    std::vector<std::string> header; ///< empty when the file has none
    std::vector<std::vector<double>> rows;
};

/// Reads a CSV file of finite numbers: an optional first line of names, empty lines and lines starting with #
/// skipped. Throws InputError with file, line and column.
CsvTable readCsv(const std::string& file);

/// The index of the thing that a word is a name of, each thing having several names: first with the same
/// case, else regardless of case where only one thing matches. names.size(): none.
std::size_t columnNamed(const std::vector<std::vector<std::string>>& names, const std::string& word);

/// Whether a column is called `step` (steps or time codes), or `time` (seconds).
bool isStep(const std::string& word);
bool isTime(const std::string& word);

/// What the columns of a file of DOF values may be called: of each DOF `/PATH/JOINT:DOF`, and `JOINT:DOF`,
/// `JOINT` or `DOF` where that is no other's name.
struct DofColumns {
    std::vector<Dof> dofs; ///< in the order in which values are wanted
    std::vector<std::vector<std::string>> names;
};
DofColumns dofColumns(const SceneModel& scene);                   ///< of all joints, in file order
DofColumns dofColumns(const SceneModel& scene, const Pair& pair); ///< as in pairMotion()

/// The rows of a file with a column a DOF, in the DOFs' order and their own units; `remark`: what is to be
/// said of it, or empty. The first line may name the columns in any order; where it has none of the names
/// they are taken in the DOFs' order. Throws InputError where some of the names are those of DOFs and others
/// are not, or one comes twice. A value beyond a limit by no more than rounding to 6 digits becomes the
/// limit. stepped: a first column `step` or `time` is ignored, and a DOF without a column stays at rest; else
/// each DOF needs a column.
struct DofRows {
    std::vector<std::vector<double>> rows;
    std::string remark;
};
DofRows readDofRows(const std::string& file, const DofColumns& columns, bool stepped = false);

} // namespace tss::tool
