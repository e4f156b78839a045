// Goldfarb and Idnani, "A numerically stable dual method for solving strictly convex quadratic programs",
// 1983.
#include "bake/motion/JointQp.h"

#include "bake/base/Infinity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tss {

namespace {

/// Of N unknowns: joints have few, and loops of known length over them are what the time goes into.
template <int N>
using Values = std::array<double, std::size_t(N)>;

template <int N>
double dot(const double* a, const double* b) {
    double sum = 0;
    for (int l = 0; l < N; ++l) sum += a[l] * b[l];
    return sum;
}

/// The rows that hold with equality, their multipliers, and the QR factors of their normals.
template <int N>
struct ActiveSet {
    int count = 0;
    std::array<int, std::size_t(N)> row;
    Values<N> multiplier;
    std::array<Values<N>, std::size_t(N)> basis; ///< orthonormal, one per member
    std::array<Values<N>, std::size_t(N)> upper; ///< upper[j][i], i <= j: normal j in that basis

    /// Splits a normal into its part along the basis (coefficients) and the rest; twice, for orthogonality.
    Values<N> split(const double* normal, Values<N>& rest) const {
        Values<N> along{};
        std::copy_n(normal, N, rest.begin());
        for (int pass = 0; pass < 2; ++pass)
            for (int i = 0; i < count; ++i) {
                const double c = dot<N>(basis[i].data(), rest.data());
                along[i] += c;
                for (int l = 0; l < N; ++l) rest[l] -= c * basis[i][l];
            }
        return along;
    }

    /// normal = sum_i r_i normal_i + rest.
    Values<N> combination(const Values<N>& along) const {
        Values<N> r{};
        for (int i = count; i-- > 0;) {
            double sum = along[i];
            for (int j = i + 1; j < count; ++j) sum -= upper[j][i] * r[j];
            r[i] = sum / upper[i][i];
        }
        return r;
    }

    void add(int index, const double* normal, double value) {
        Values<N> rest;
        upper[count] = split(normal, rest);
        const double length = std::sqrt(dot<N>(rest.data(), rest.data()));
        upper[count][count] = length;
        for (int l = 0; l < N; ++l) basis[count][l] = rest[l] / length;
        row[count] = index;
        multiplier[count++] = value;
    }

    void remove(int place, const QpRows& rows) {
        const int old = count;
        count = place;
        for (int j = place + 1; j < old; ++j) {
            const int index = row[j];
            add(index, rows.normal(index), multiplier[j]);
        }
    }
};

template <int N>
bool nearest(const QpRows& rows, double tolerance, double* y, QpActive* held) {
    ActiveSet<N> active;
    for (int changes = 0; changes < 200;) {
        int worst = -1;
        double excess = -tolerance;
        const double* row = rows.normal(0);
        for (int i = 0; i < rows.count(); ++i, row += N + 1) {
            const double e = dot<N>(row, y) - row[N];
            if (e < excess) {
                excess = e;
                worst = i;
            }
        }
        if (worst < 0) {
            for (int j = 0; held && j < active.count; ++j)
                if (active.multiplier[j] > 0) held->rows[std::size_t(held->count++)] = active.row[j];
            return true;
        }

        double multiplier = 0;
        for (bool added = false; !added; ++changes) {
            if (changes >= 200) return false;
            Values<N> rest;
            const Values<N> r = active.combination(active.split(rows.normal(worst), rest));
            const double free = active.count < N ? dot<N>(rest.data(), rest.data()) : 0;
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
                for (int l = 0; l < N; ++l) y[l] += step * rest[l];
                excess = dot<N>(rows.normal(worst), y) - rows.bound(worst);
            }
            added = full <= partial;
            if (added)
                active.add(worst, rows.normal(worst), multiplier);
            else
                active.remove(leaving, rows);
        }
    }
    return false;
}

template <std::size_t... N>
bool nearestOf(std::index_sequence<N...>, const QpRows& rows, double tolerance, double* y, QpActive* held) {
    using Solver = bool (*)(const QpRows&, double, double*, QpActive*);
    constexpr Solver solvers[] = {nearest<int(N) + 1>...};
    return solvers[rows.unknowns() - 1](rows, tolerance, y, held);
}

} // namespace

bool nearestToOrigin(const QpRows& rows, double tolerance, DofValues& y, QpActive* active) {
    y.fill(0);
    if (active) active->count = 0;
    if (rows.unknowns() > 0)
        return nearestOf(std::make_index_sequence<maxDofs>(), rows, tolerance, y.data(), active);
    for (int i = 0; i < rows.count(); ++i)
        if (rows.bound(i) > tolerance) return false;
    return true;
}

} // namespace tss
