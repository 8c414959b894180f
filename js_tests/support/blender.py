# SPDX-License-Identifier: MIT
# What somebody does who opens a GLB in Blender and exports it: blender -b --python blender.py -- IN.glb OUT KIND [draco]
# KIND glb or ply is written as such; obj and stl are opened again and written to OUT, a GLB.
import os
import sys

import bpy
import numpy

numpy.bool = bool  # Blender 3.4's glTF importer says numpy.bool, which numpy 1.24 no longer has

source, target, kind, *options = sys.argv[sys.argv.index('--') + 1:]
other = os.path.splitext(target)[0] + '.' + kind


def empty():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def export_glb(draco):
    bpy.ops.export_scene.gltf(filepath=target, export_format='GLB', export_draco_mesh_compression_enable=draco)


if 'draco' in options:
    from io_scene_gltf2.io.com.gltf2_io_draco_compression_extension import dll_exists
    if not dll_exists(quiet=True):
        print('quadmark: this Blender comes without its Draco library (libextern_draco.so)')
        sys.exit(3)

empty()
bpy.ops.import_scene.gltf(filepath=source)
if kind == 'glb':
    export_glb('draco' in options)
elif kind == 'ply':
    bpy.ops.export_mesh.ply(filepath=target, use_ascii=True)
elif kind == 'obj':
    bpy.ops.wm.obj_export(filepath=other)
    empty()
    bpy.ops.wm.obj_import(filepath=other)
    export_glb(False)
elif kind == 'stl':
    bpy.ops.export_mesh.stl(filepath=other)
    empty()
    bpy.ops.import_mesh.stl(filepath=other)
    export_glb(False)
