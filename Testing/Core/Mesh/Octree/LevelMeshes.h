// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_HexOctree_LevelMeshes_h
#define banyan_Testing_Core_HexOctree_LevelMeshes_h

#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/HexBrickSource.h"
#include "Render/Scenes.h"

namespace levels
{

using namespace banyan;
using meshes::Cube;

inline const glm::ivec3 Size(64, 32, 32);

struct Made
{
  meshes::OwnMesh<double, std::int64_t> Mesh;
  std::vector<float> Values;
  std::shared_ptr<const HexBricks> Bricks;

  Made(meshes::OwnMesh<double, std::int64_t> mesh, const scenes::Field& field)
    : Mesh(std::move(mesh))
    , Values(Mesh.Sampled<float>([&](const glm::dvec3& p) { return field(p / glm::dvec3(Size)); }))
    , Bricks(std::make_shared<const HexBricks>(meshes::Find(Mesh.Mesh()), 8))
  {
  }
  Made(const std::vector<Cube>& cubes, const scenes::Field& field)
    : Made(meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3), field)
  {
  }

  HexBrickSource Source(ThreadPool& pool) const
  {
    NodeArray array;
    array.Values = this->Values.data();
    return HexBrickSource(this->Bricks, array, pool);
  }

  RayScene Scene(double step, double distance = 1.4) const
  {
    RayScene scene = scenes::Scene(Size + 1, { 90, 70 }, glm::dmat4(1.0), distance);
    scene.IndexToWorld = this->Bricks->Tree().LatticeToWorld();
    scene.DomainCells = this->Bricks->Tree().Domain();
    scene.SampleDistance = step;
    scene.Levels = LevelEdges::Finest();
    return scene;
  }
};

inline std::vector<Cube> Graded()
{
  return meshes::Ball({ 2, 1, 1 }, 5);
}

inline std::vector<Cube> Rough()
{
  return meshes::Wild({ 2, 1, 1 }, 5, 4);
}

/// With cells left out here and there.
inline std::vector<Cube> Holed()
{
  std::vector<Cube> cubes;
  for (const Cube& cube : Rough())
  {
    if ((cube.Corner.x + 3 * cube.Corner.y + 5 * cube.Corner.z) % 11 != 0)
    {
      cubes.push_back(cube);
    }
  }
  return cubes;
}

inline const HexBrickSource& At(HexBrickSource& source, int level, const Box& domain)
{
  return dynamic_cast<const HexBrickSource&>(*source.AtLevel(level, domain));
}

template <class Function>
void ForPoints(const glm::ivec3& size, const Function& function)
{
  for (int z = 0; z < size.z; ++z)
  {
    for (int y = 0; y < size.y; ++y)
    {
      for (int x = 0; x < size.x; ++x)
      {
        function(glm::ivec3(x, y, z));
      }
    }
  }
}

} // namespace levels

#endif
