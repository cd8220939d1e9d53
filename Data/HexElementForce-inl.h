// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_HexElementForce_inl_h
#define banyan_Data_HexElementForce_inl_h

namespace banyan
{

/// Nodal forces of elastic cubes with trilinear displacements, integrated exactly: the constant 24
/// x 24 stiffness matrices of a cube, times the moduli and the edge, in 1/5 of the operations.
///
/// The displacement of a cube is a sum of eight modes (1, x, y, z, xy, ...) that are orthogonal,
/// and so are their derivatives; a Walsh-Hadamard transform leads from nodes to modes and back.
/// What couples modes are few entries.
///
/// @param u displacements in, forces out: `[component][node]`, node numbers with x fastest
/// @param lambda, mu Lame's moduli times -edge / 16
/// @tparam V a number or a vector of numbers, one per cube
template <typename V>
inline void HexElementForce(V (&u)[3][8], const V& lambda, const V& mu)
{
  for (auto& a : u)
  {
    for (int bit = 1; bit < 8; bit *= 2)
    {
      for (int low = 0; low < 8; ++low)
      {
        if (!(low & bit))
        {
          const V sum = a[low] + a[low | bit], difference = a[low | bit] - a[low];
          a[low] = sum;
          a[low | bit] = difference;
        }
      }
    }
  }
  // Mode m is the product of the coordinates whose bits are in m. A derivative takes a bit away;
  // modes of k coordinates have a square of 3^-k on average.
  V force[3][8];
  const V third = mu * (1.0f / 3.0f), lambdaThird = lambda * (1.0f / 3.0f);
  const V dilation = lambda * (u[0][1] + u[1][2] + u[2][4]);
  const V last = (lambda + 4.0f * mu) * (1.0f / 9.0f);
  for (int c = 0; c < 3; ++c)
  {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    const int C = 1 << c, I = 1 << i, J = 1 << j;
    force[c][0] = mu - mu; // no force moves a cube as a whole
    force[c][C] = dilation + 2.0f * mu * u[c][C];
    force[c][I] = mu * (u[c][I] + u[i][C]);
    force[c][J] = mu * (u[c][J] + u[j][C]);
    force[c][C | I] = lambdaThird * (u[c][C | I] + u[j][J | I]) + mu * u[c][C | I];
    force[c][C | J] = lambdaThird * (u[c][C | J] + u[i][I | J]) + mu * u[c][C | J];
    force[c][I | J] = third * (2.0f * u[c][I | J] + u[i][J | C] + u[j][I | C]);
    force[c][7] = last * u[c][7];
  }
  for (int c = 0; c < 3; ++c)
  {
    for (int bit = 1; bit < 8; bit *= 2)
    {
      for (int low = 0; low < 8; ++low)
      {
        if (!(low & bit))
        {
          const V sum = force[c][low] + force[c][low | bit];
          force[c][low] -= force[c][low | bit];
          force[c][low | bit] = sum;
        }
      }
    }
    for (int node = 0; node < 8; ++node)
    {
      u[c][node] = force[c][node];
    }
  }
}

} // namespace banyan

#endif
