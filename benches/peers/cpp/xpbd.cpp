// XPBD with small steps (Macklin et al., "Small Steps in Physics Simulation", SCA 2019, doi:10.1145/3309486.3340247):
// one pass of Gauss–Seidel over the rods in every substep, zero compliance, velocities from the change of positions.
//
//   substeps     steps a frame

#include "peer.hpp"

namespace {

template <int D>
Frame xpbd(const Workload& workload, int substeps) {
    const double h = workload.frame / substeps;
    const int n = workload.particles(), rods = workload.rods();
    Numbers w(n);
    for (int i = 0; i < n; ++i) w[i] = workload.inverse_mass(i);
    return [=, before = Numbers()](State& state) mutable {
        Numbers &q = state.q, &qd = state.qd;
        for (int step = 0; step < substeps; ++step) {
            before = q;
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < D && w[i] > 0.0; ++k) {
                    qd[i * D + k] += h * workload.gravity[k];
                    q[i * D + k] += h * qd[i * D + k];
                }
            for (int rod = 0; rod < rods; ++rod) {
                double* a = &q[workload.ends[2 * rod] * D];
                double* b = &q[workload.ends[2 * rod + 1] * D];
                const double wa = w[workload.ends[2 * rod]], wb = w[workload.ends[2 * rod + 1]];
                double d[D], square = 0.0;
                for (int k = 0; k < D; ++k) {
                    d[k] = b[k] - a[k];
                    square += d[k] * d[k];
                }
                const double length = std::sqrt(square);
                const double scale = (length - workload.lengths[rod]) / (length * (wa + wb));
                for (int k = 0; k < D; ++k) {
                    a[k] += wa * scale * d[k];
                    b[k] -= wb * scale * d[k];
                }
            }
            for (std::size_t i = 0; i < q.size(); ++i) qd[i] = (q[i] - before[i]) / h;
        }
    };
}

}  // namespace

int main(int count, char** words) {
    return peer_main(count, words, [](const Workload& workload, const Setting& setting) {
        const int substeps = std::stoi(setting.at("substeps"));
        return workload.dimension == 2 ? xpbd<2>(workload, substeps) : xpbd<3>(workload, substeps);
    });
}
