// SPDX-License-Identifier: Apache-2.0
// Reads transforms and images of labels with ITK and prints what it finds; shares no code with the program.
//
// usage: read_by_itk FILE ...
// Per transform (.tfm, .h5) one line: "transform" and where ITK maps (10, 20, 30). Per image (.nrrd, .nii) one line: "image",
// size, spacing, origin, direction by rows, and the sum of all samples. The exit code is 1 if ITK throws.
#include <itkHDF5TransformIO.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageRegionConstIterator.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkTransform.h>
#include <itkTransformFileReader.h>
#include <itkTxtTransformIO.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

template <class TransformIO>
void print_transform(const std::string& file) {
    using Reader = itk::TransformFileReaderTemplate<double>;
    const auto reader = Reader::New();
    reader->SetFileName(file);
    reader->SetTransformIO(TransformIO::New());
    reader->Update();
    const auto* list = reader->GetTransformList();
    if (list->size() != 1) throw std::runtime_error("not one transform");
    const auto* transform = dynamic_cast<const itk::Transform<double, 3, 3>*>(list->front().GetPointer());
    if (!transform) throw std::runtime_error("no transform of three dimensions");
    itk::Point<double, 3> point;
    point[0] = 10.0, point[1] = 20.0, point[2] = 30.0;
    const auto there = transform->TransformPoint(point);
    std::printf("transform %.17g %.17g %.17g\n", there[0], there[1], there[2]);
}

template <class ImageIO>
void print_image(const std::string& file) {
    using Image = itk::Image<short, 3>;
    const auto reader = itk::ImageFileReader<Image>::New();
    reader->SetFileName(file);
    reader->SetImageIO(ImageIO::New());
    reader->Update();
    const Image* image = reader->GetOutput();
    std::printf("image");
    for (unsigned axis = 0; axis < 3; ++axis)
        std::printf(" %zu", size_t(image->GetLargestPossibleRegion().GetSize()[axis]));
    for (unsigned axis = 0; axis < 3; ++axis) std::printf(" %.17g", image->GetSpacing()[axis]);
    for (unsigned axis = 0; axis < 3; ++axis) std::printf(" %.17g", image->GetOrigin()[axis]);
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 3; ++column) std::printf(" %.17g", image->GetDirection()(row, column));
    long long sum = 0;
    for (itk::ImageRegionConstIterator<Image> at(image, image->GetLargestPossibleRegion()); !at.IsAtEnd(); ++at)
        sum += at.Get();
    std::printf(" %lld\n", sum);
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

int main(int count, char** words) {
    try {
        for (int n = 1; n < count; ++n) {
            const std::string file = words[n];
            if (ends_with(file, ".tfm")) print_transform<itk::TxtTransformIOTemplate<double>>(file);
            else if (ends_with(file, ".h5")) print_transform<itk::HDF5TransformIOTemplate<double>>(file);
            else if (ends_with(file, ".nrrd")) print_image<itk::NrrdImageIO>(file);
            else print_image<itk::NiftiImageIO>(file);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
