// SPDX-License-Identifier: BSD-3-Clause
// Elastic forces of octree meshes against matrices from numerical integration, and the patch test.
#include "HexElementForce-inl.h"
#include "HexForces.h"
#include "WaveMesh.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using banyan::HexForces;
using banyan::OctreeMesh;
using banyan::ThreadPool;
using banyan::WaveMesh;

namespace
{

using Matrix = std::array<std::array<double, 24>, 24>;

/// The stiffness matrix of a cube of edge 1 by Gauss's rule, two points an axis: exact. Row 3 *
/// node
/// + component, nodes with x fastest. The slow and obvious way.
Matrix Stiffness(double lambda, double mu)
{
  Matrix matrix{};
  for (int point = 0; point < 8; ++point)
  {
    double at[3], slope[8][3];
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] = 0.5 + ((point >> axis & 1) - 0.5) / std::sqrt(3.0);
    }
    for (int node = 0; node < 8; ++node)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        slope[node][axis] = node >> axis & 1 ? 1.0 : -1.0;
        for (int other = 0; other < 3; ++other)
        {
          slope[node][axis] *= other == axis ? 1.0 : node >> other & 1 ? at[other] : 1 - at[other];
        }
      }
    }
    for (int a = 0; a < 24; ++a)
    {
      for (int b = 0; b < 24; ++b)
      {
        const int i = a % 3, j = b % 3;
        const double *ga = slope[a / 3], *gb = slope[b / 3];
        const double dot = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
        matrix[a][b] +=
          (lambda * ga[i] * gb[j] + mu * (ga[j] * gb[i] + (i == j ? dot : 0.0))) / 8.0;
      }
    }
  }
  return matrix;
}

struct Moduli
{
  std::vector<float> Lambda, Mu;
};

Moduli RandomModuli(const OctreeMesh& mesh)
{
  std::mt19937 random(5);
  Moduli moduli;
  for (std::size_t i = 0; i < mesh.CellCount(); ++i)
  {
    moduli.Lambda.push_back(0.5f + random() % 1000 / 500.0f);
    moduli.Mu.push_back(0.5f + random() % 1000 / 500.0f);
  }
  return moduli;
}

} // namespace

TEST(HexForces, ACubeResistsAsItsMatrixSays)
{
  std::mt19937 random(2);
  const auto chance = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (int round = 0; round < 20; ++round)
  {
    // Also lambda below zero, as some solids have.
    const double lambda = 3.0 * chance(), mu = 1.0 + chance(), edge = 0.3;
    const Matrix matrix = Stiffness(lambda, mu);
    double u[3][8], original[24];
    for (int k = 0; k < 24; ++k)
    {
      original[k] = u[k % 3][k / 3] = chance();
    }
    banyan::HexElementForce(u, -lambda * edge / 16.0, -mu * edge / 16.0);
    for (int k = 0; k < 24; ++k)
    {
      double force = 0.0;
      for (int l = 0; l < 24; ++l)
      {
        force -= edge * matrix[k][l] * original[l];
      }
      ASSERT_NEAR(u[k % 3][k / 3], force, 1e-7) << k;
    }
  }
}

TEST(HexForces, AMeshResistsAsItsCellsTogether)
{
  ThreadPool pool(2);
  // More than one block of cells, and a last block that is not full.
  const OctreeMesh mesh = WaveMesh::Random({ 7, 6, 5 }, 1, pool);
  ASSERT_GT(mesh.CellCount(), 4096u);
  ASSERT_GT(mesh.Hanging().size(), 100u);
  const Moduli moduli = RandomModuli(mesh);
  std::mt19937 random(3);
  std::vector<float> u(3 * mesh.NodeCount()), f(u.size(), 99.0f);
  for (float& value : u)
  {
    value = static_cast<float>(random() % 2000) / 1000.0f - 1.0f;
  }
  HexForces(mesh, moduli.Lambda, moduli.Mu, pool).Apply(u.data(), f.data());
  const Matrix one = Stiffness(1.0, 0.0), two = Stiffness(0.0, 1.0);
  std::vector<double> slow(u.size(), 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < mesh.CellCount(); ++i)
  {
    const double edge = mesh.EdgeOfLevel(mesh.Cell(i).Level);
    for (int k = 0; k < 24; ++k)
    {
      double force = 0.0;
      for (int l = 0; l < 24; ++l)
      {
        force -= edge * (moduli.Lambda[i] * one[k][l] + moduli.Mu[i] * two[k][l]) *
                 u[3 * mesh.Corners(i)[l / 3] + l % 3];
      }
      slow[3 * mesh.Corners(i)[k / 3] + k % 3] += force;
    }
  }
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    largest = std::max(largest, std::abs(slow[i]));
  }
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    ASSERT_NEAR(f[i], slow[i], 2e-6 * largest) << i;
  }
}

TEST(HexForces, ConstantStrainNeedsNoForcesInside)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Random({ 3, 3, 3 }, 8, pool);
  ASSERT_GT(mesh.Hanging().size(), 100u);
  const double lambda = 2.0, mu = 3.0;
  const std::vector<float> lambdas(mesh.CellCount(), 2.0f), mus(mesh.CellCount(), 3.0f);
  const double strain[3][3] = { { 0.5, -0.25, 1.0 }, { 0.75, -1.0, 0.5 }, { 0.25, 0.125, 2.0 } };
  std::vector<float> u(3 * mesh.NodeCount()), f(u.size());
  for (std::size_t node = 0; node < mesh.NodeCount(); ++node)
  {
    const auto p = mesh.Point(node);
    for (int c = 0; c < 3; ++c)
    {
      u[3 * node + c] =
        static_cast<float>(strain[c][0] * p[0] + strain[c][1] * p[1] + strain[c][2] * p[2]);
    }
  }
  // What hangs lies where its masters put it.
  for (const auto& hanging : mesh.Hanging())
  {
    for (int c = 0; c < 3; ++c)
    {
      float mean = 0.0f;
      for (const std::uint32_t master : hanging.Masters)
      {
        mean += 0.25f * u[3 * master + c];
      }
      ASSERT_EQ(mean, u[3 * hanging.Node + c]);
    }
  }
  HexForces(mesh, lambdas, mus, pool).Apply(u.data(), f.data());
  for (const auto& hanging : mesh.Hanging())
  {
    for (int c = 0; c < 3; ++c)
    {
      for (const std::uint32_t master : hanging.Masters)
      {
        f[3 * master + c] += 0.25f * f[3 * hanging.Node + c];
      }
      f[3 * hanging.Node + c] = 0.0f;
    }
  }
  // Forces on the sides are the stress times the area.
  double pull[6][3] = {}, inside = 0.0;
  for (std::size_t node = 0; node < mesh.NodeCount(); ++node)
  {
    const auto p = mesh.Point(node);
    bool within = true;
    for (int side = 0; side < 6; ++side)
    {
      within = within && p[side / 2] != (side % 2 ? 1200.0 : 0.0);
    }
    for (int c = 0; c < 3; ++c)
    {
      for (int axis = 0; axis < 3 && !within; ++axis)
      {
        // First moments of the forces: the sum over all of force times place.
        pull[axis][c] -= f[3 * node + c] * p[axis];
      }
      inside = within ? std::max<double>(inside, std::abs(f[3 * node + c])) : inside;
    }
  }
  const double volume = 1200.0 * 1200.0 * 1200.0;
  const double trace = strain[0][0] + strain[1][1] + strain[2][2];
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double stress =
        (axis == c ? lambda * trace : 0.0) + mu * (strain[axis][c] + strain[c][axis]);
      EXPECT_NEAR(pull[axis][c] / volume, stress, 1e-4);
    }
  }
  // A node of the smallest cells, 50 m wide, feels forces of about stress times 2500 m^2.
  EXPECT_LT(inside, 1e-5 * 6.0 * 400.0 * 400.0);
}

TEST(HexForces, AnyNumberOfThreadsGivesTheSameBits)
{
  std::vector<float> results[2];
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    const OctreeMesh mesh = WaveMesh::Random({ 7, 6, 5 }, 1, pool);
    const Moduli moduli = RandomModuli(mesh);
    std::mt19937 random(4);
    std::vector<float> u(3 * mesh.NodeCount()), f(u.size());
    for (float& value : u)
    {
      value = static_cast<float>(random() % 2000) / 1000.0f - 1.0f;
    }
    HexForces forces(mesh, moduli.Lambda, moduli.Mu, pool);
    forces.Apply(u.data(), f.data());
    results[threads > 1] = f;
    forces.Apply(u.data(), f.data());
    EXPECT_TRUE(results[threads > 1] == f);
  }
  EXPECT_TRUE(results[0] == results[1]);
}
