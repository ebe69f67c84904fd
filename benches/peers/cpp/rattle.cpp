// RATTLE (Andersen 1983, doi:10.1016/0021-9991(83)90014-1) with fixed steps on Eigen's sparse LDLᵀ:
//
//   q' = q + h (q̇ + h/2 W (Q + J(q)ᵀ λ)),  |d'| = r         Newton on the rods' lengths with A = J(q) W J(q)ᵀ
//   q̇' = (q' − q)/h + h/2 W (Q + J(q')ᵀ μ),  J(q') q̇' = 0   one solve with A at q', which serves the next step
//
// It ends with an error if A has no LDLᵀ or Newton does not converge.
//
//   substeps     steps a frame

#include "peer.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <memory>

namespace {

constexpr double tolerance = 1e-10;  // relative to a rod's length, as in qhat
constexpr int iterations = 50;       // a simplified Newton method that has not converged by then diverges

template <int D>
class Rattle {
public:
    Rattle(const Workload& workload, int substeps)
        : workload_(workload), substeps_(substeps), h_(workload.frame / substeps), C_(workload.rods()),
          along_(workload.rods()) {
        structure();
        gradient(Eigen::Map<const Vector>(workload.positions.data(), workload.positions.size()));
        solver_.analyzePattern(A_);
        factor();
    }

    void frame(State& state) {
        Eigen::Map<Vector> q(state.q.data(), state.q.size()), qd(state.qd.data(), state.qd.size());
        for (int step = 0; step < substeps_; ++step) {
            fall(qd, h_ / 2);
            next_ = q + h_ * qd;
            // The gradients are those at q, so λ acts along the rods at the start of the step.
            for (int iteration = 0;; ++iteration) {
                const double worst = stretch(next_);
                if (worst <= tolerance && iteration > 0) break;
                if (!(worst < 1e3) || iteration == iterations) throw std::runtime_error("Newton did not converge");
                pull(next_, solver_.solve(C_));
            }
            qd = (next_ - q) / h_;
            fall(qd, h_ / 2);
            q = next_;
            gradient(q);
            factor();
            for (int rod = 0; rod < workload_.rods(); ++rod) C_[rod] = along_[rod].dot(difference(qd, rod));
            pull(qd, solver_.solve(C_));
        }
    }

private:
    using Block = Eigen::Matrix<double, D, 1>;
    using Vector = Eigen::VectorXd;

    // The contribution of one particle to one entry of A.
    struct Share {
        int one, other, value;
        double weight;
    };

    // The lower triangle of A has an entry for every two rods that share a moving particle.
    void structure() {
        std::vector<std::vector<int>> rods(workload_.particles());
        for (int end = 0; end < 2 * workload_.rods(); ++end) rods[workload_.ends[end]].push_back(end);
        std::vector<Eigen::Triplet<double>> entries;
        const auto each = [&](auto meet) {
            for (int particle = 0; particle < workload_.particles(); ++particle)
                for (int one : rods[particle])
                    for (int other : rods[particle])
                        if (!workload_.fixed[particle] && one / 2 >= other / 2) meet(particle, one, other);
        };
        each([&](int, int one, int other) { entries.emplace_back(one / 2, other / 2, 0.0); });
        A_.resize(workload_.rods(), workload_.rods());
        A_.setFromTriplets(entries.begin(), entries.end());
        each([&](int particle, int one, int other) {
            const int value = static_cast<int>(&A_.coeffRef(one / 2, other / 2) - A_.valuePtr());
            const double sign = one % 2 == other % 2 ? 1.0 : -1.0;
            shares_.push_back({one / 2, other / 2, value, sign * workload_.inverse_mass(particle)});
        });
    }

    Block difference(const Eigen::Ref<const Vector>& of, int rod) const {
        const int a = workload_.ends[2 * rod] * D, b = workload_.ends[2 * rod + 1] * D;
        return of.template segment<D>(b) - of.template segment<D>(a);
    }

    // C = |d| − r of every rod; returns the largest over the rod's length.
    double stretch(const Vector& q) {
        double worst = 0.0;
        for (int rod = 0; rod < workload_.rods(); ++rod) {
            C_[rod] = difference(q, rod).norm() - workload_.lengths[rod];
            const double relative = std::abs(C_[rod]) / workload_.lengths[rod];
            if (!(relative <= worst)) worst = relative;
        }
        return worst;
    }

    void gradient(const Eigen::Ref<const Vector>& q) {
        for (int rod = 0; rod < workload_.rods(); ++rod) along_[rod] = difference(q, rod).normalized();
    }

    void factor() {
        std::fill_n(A_.valuePtr(), A_.nonZeros(), 0.0);
        for (const Share& share : shares_)
            A_.valuePtr()[share.value] += share.weight * along_[share.one].dot(along_[share.other]);
        solver_.factorize(A_);
        if (solver_.info() != Eigen::Success) throw std::runtime_error("A has no factor");
    }

    // Subtracts W Jᵀ λ.
    void pull(Eigen::Ref<Vector> from, const Vector& lambda) const {
        for (int rod = 0; rod < workload_.rods(); ++rod) {
            const int a = workload_.ends[2 * rod], b = workload_.ends[2 * rod + 1];
            from.template segment<D>(a * D) += workload_.inverse_mass(a) * lambda[rod] * along_[rod];
            from.template segment<D>(b * D) -= workload_.inverse_mass(b) * lambda[rod] * along_[rod];
        }
    }

    void fall(Eigen::Ref<Vector> qd, double time) const {
        for (int i = 0; i < workload_.particles() * D; ++i)
            if (!workload_.fixed[i / D]) qd[i] += time * workload_.gravity[i % D];
    }

    const Workload& workload_;
    int substeps_;
    double h_;
    Vector C_, next_;
    std::vector<Block> along_;
    std::vector<Share> shares_;
    Eigen::SparseMatrix<double> A_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

template <int D>
Frame rattle(const Workload& workload, int substeps) {
    auto method = std::make_shared<Rattle<D>>(workload, substeps);
    return [method](State& state) { method->frame(state); };
}

}  // namespace

int main(int count, char** words) {
    return peer_main(count, words, [](const Workload& workload, const Setting& setting) {
        const int substeps = std::stoi(setting.at("substeps"));
        return workload.dimension == 2 ? rattle<2>(workload, substeps) : rattle<3>(workload, substeps);
    });
}
