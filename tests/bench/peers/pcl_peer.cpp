// Runs PCL's moving least squares on a PLY file, on one thread:
//
//   pcl-peer mls      IN OUT radius= order=
//   pcl-peer plane    IN OUT radius= order= reach= step=       upsampling: lattices in tangent
//   planes pcl-peer random   IN OUT radius= order= density=           upsampling: random, points in
//   a disk pcl-peer voxels   IN OUT radius= order= voxel= dilations=  upsampling: of dilated voxels
//
// Lengths are in the units of the file.

#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>

#include <exception>
#include <iostream>

#include "tests/bench/peers/settings.h"

namespace lpf::peers {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Mls = pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ>;

Cloud::Ptr read(const std::string& path) {
    Cloud::Ptr cloud(new Cloud);
    if (pcl::PLYReader().read(path, *cloud) < 0 || cloud->empty()) {
        throw std::runtime_error(path + " cannot be read");
    }
    return cloud;
}

void choose_upsampling(Mls& mls, const std::string& method, const Settings& settings) {
    if (method == "plane") {
        mls.setUpsamplingMethod(Mls::SAMPLE_LOCAL_PLANE);
        mls.setUpsamplingRadius(settings.number("reach"));
        mls.setUpsamplingStepSize(settings.number("step"));
    } else if (method == "random") {
        mls.setUpsamplingMethod(Mls::RANDOM_UNIFORM_DENSITY);
        mls.setPointDensity(static_cast<int>(settings.count("density")));
    } else if (method == "voxels") {
        mls.setUpsamplingMethod(Mls::VOXEL_GRID_DILATION);
        mls.setDilationVoxelSize(static_cast<float>(settings.number("voxel")));
        mls.setDilationIterations(static_cast<int>(settings.count("dilations")));
    } else if (method != "mls") {
        throw std::invalid_argument("no method '" + method + "': mls, plane, random, voxels");
    }
}

Cloud processed(const std::string& method, const Cloud::Ptr& cloud, const Settings& settings) {
    Mls mls;
    mls.setInputCloud(cloud);
    mls.setSearchMethod(
        pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
    mls.setSearchRadius(settings.number("radius"));
    mls.setPolynomialOrder(static_cast<int>(settings.count("order")));
    mls.setNumberOfThreads(1);
    choose_upsampling(mls, method, settings);
    Cloud result;
    mls.process(result);
    return result;
}

}  // namespace
}  // namespace lpf::peers

int main(int argc, char** argv) {
    try {
        if (argc < 4) throw std::invalid_argument("usage: pcl-peer METHOD IN OUT NAME=NUMBER ...");
        using namespace lpf::peers;
        const Cloud result = processed(argv[1], read(argv[2]), Settings(argc, argv, 4));
        if (pcl::PLYWriter().write(argv[3], result, true, false) < 0) {
            throw std::runtime_error(std::string(argv[3]) + " cannot be written");
        }
    } catch (const std::exception& error) {
        std::cerr << "pcl-peer: " << error.what() << '\n';
        return 1;
    }
}
