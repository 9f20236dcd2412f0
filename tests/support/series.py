"""Reading what a run wrote, without Silt: the index by its XML, the numbers by h5py."""
import os
import xml.etree.ElementTree

import h5py


def outputs(folder, name):
    """[(time, {dataset name: (file, shape as the index says)})] of `<folder>/<name>.xdmf`."""
    root = xml.etree.ElementTree.parse(os.path.join(folder, name + ".xdmf")).getroot()
    found = []
    for grid in root.findall("./Domain/Grid/Grid"):
        sets = {}
        for item in grid.iter("DataItem"):
            file, path = item.text.strip().split(":/")
            sets[path] = (os.path.join(folder, file), tuple(int(v) for v in item.get("Dimensions").split()))
        found.append((float(grid.find("Time").get("Value")), sets))
    return found


def faults(folder, name):
    """What of the index does not stand in the files as it says."""
    wrong = []
    for time, sets in outputs(folder, name):
        for path, (file, shape) in sets.items():
            try:
                with h5py.File(file, "r") as data:
                    actual = data[path].shape
                    data[path][()]
            except (OSError, KeyError) as error:
                wrong.append(f"t = {time}: {file}:/{path}: {error}")
                continue
            if actual != shape:
                wrong.append(f"t = {time}: {file}:/{path} has shape {actual}, the index says {shape}")
    return wrong


def read(folder, name, number, path):
    """One dataset of one output."""
    file, _ = outputs(folder, name)[number][1][path]
    with h5py.File(file, "r") as data:
        return data[path][()]
