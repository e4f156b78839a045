#include "bake/respond/JointQp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

namespace {

double dot(int n, const JointValues& a, const JointValues& b) {
    double sum = 0;
    for (int l = 0; l < n; ++l) sum += a[l] * b[l];
    return sum;
}

/// The rows that hold with equality, their multipliers, and the QR factors of their normals.
struct ActiveSet {
    int n = 0, count = 0;
    std::array<int, maxDofs> row{};
    JointValues multiplier{};
    std::array<JointValues, maxDofs> basis{}; ///< orthonormal, one a member
    std::array<JointValues, maxDofs> upper{}; ///< upper[j][i], i <= j: normal j in that basis

    /// Splits a normal into its part along the basis (coefficients) and the rest; twice, for orthogonality.
    JointValues split(const JointValues& normal, JointValues& rest) const {
        JointValues along{};
        rest = normal;
        for (int pass = 0; pass < 2; ++pass)
            for (int i = 0; i < count; ++i) {
                const double c = dot(n, basis[i], rest);
                along[i] += c;
                for (int l = 0; l < n; ++l) rest[l] -= c * basis[i][l];
            }
        return along;
    }

    /// normal = sum_i r_i normal_i + rest.
    JointValues combination(const JointValues& along) const {
        JointValues r{};
        for (int i = count; i-- > 0;) {
            double sum = along[i];
            for (int j = i + 1; j < count; ++j) sum -= upper[j][i] * r[j];
            r[i] = sum / upper[i][i];
        }
        return r;
    }

    void add(int index, const JointValues& normal, double value) {
        JointValues rest;
        upper[count] = split(normal, rest);
        const double length = std::sqrt(dot(n, rest, rest));
        upper[count][count] = length;
        for (int l = 0; l < n; ++l) basis[count][l] = rest[l] / length;
        row[count] = index;
        multiplier[count++] = value;
    }

    void remove(int place, const QpRow* rows) {
        const int old = count;
        count = place;
        for (int j = place + 1; j < old; ++j) {
            const int index = row[j];
            add(index, rows[index].normal, multiplier[j]);
        }
    }
};

} // namespace

bool nearestToOrigin(int n, const QpRow* rows, int rowCount, double tolerance, JointValues& y) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    y.fill(0);
    ActiveSet active;
    active.n = n;
    for (int changes = 0; changes < 200;) {
        int worst = -1;
        double excess = -tolerance;
        for (int i = 0; i < rowCount; ++i) {
            const double e = dot(n, rows[i].normal, y) - rows[i].bound;
            if (e < excess) {
                excess = e;
                worst = i;
            }
        }
        if (worst < 0) return true;

        double multiplier = 0;
        for (bool added = false; !added; ++changes) {
            if (changes >= 200) return false;
            JointValues rest;
            const JointValues r = active.combination(active.split(rows[worst].normal, rest));
            const double free = active.count < n ? dot(n, rest, rest) : 0;
            const double full = free > 1e-16 ? -excess / free : infinity;
            double partial = infinity;
            int leaving = -1;
            for (int j = 0; j < active.count; ++j)
                if (r[j] > 0 && active.multiplier[j] / r[j] < partial) {
                    partial = active.multiplier[j] / r[j];
                    leaving = j;
                }
            const double step = std::min(full, partial);
            if (!(step < infinity)) return false;
            for (int j = 0; j < active.count; ++j) active.multiplier[j] -= step * r[j];
            multiplier += step;
            if (full < infinity) {
                for (int l = 0; l < n; ++l) y[l] += step * rest[l];
                excess = dot(n, rows[worst].normal, y) - rows[worst].bound;
            }
            added = full <= partial;
            if (added)
                active.add(worst, rows[worst].normal, multiplier);
            else
                active.remove(leaving, rows);
        }
    }
    return false;
}

} // namespace tss
