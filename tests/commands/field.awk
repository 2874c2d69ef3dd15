# SPDX-License-Identifier: Apache-2.0
# awk -v rings=R -v side=S -f field.awk: a COLLADA file on standard output: a sphere of 4 R (R - 1) triangles
# that stands in S x S places, turned, stretched evenly and mirrored, and a floor below.
function vertex(i, j,    a, b)
{
    a = 3.14159265358979 * i / rings
    b = 3.14159265358979 * j / rings
    return sprintf("%.6g %.6g %.6g ", sin(a) * cos(b), cos(a), sin(a) * sin(b))
}

function geometry(name, points, vertices, corners, triangles)
{
    print "<geometry id=\"" name "\" name=\"" name "\"><mesh>"
    print "<source id=\"" name "-p\"><float_array id=\"" name "-a\" count=\"" 3 * vertices "\">" points "</float_array>"
    print "<technique_common><accessor source=\"#" name "-a\" count=\"" vertices "\" stride=\"3\">"
    print "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
    print "</accessor></technique_common></source>"
    print "<vertices id=\"" name "-v\"><input semantic=\"POSITION\" source=\"#" name "-p\"/></vertices>"
    print "<triangles count=\"" triangles "\"><input semantic=\"VERTEX\" source=\"#" name "-v\" offset=\"0\"/>"
    print "<p>" corners "</p></triangles></mesh></geometry>"
}

BEGIN {
    print "<?xml version=\"1.0\"?>"
    print "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
    print "<asset><up_axis>Y_UP</up_axis></asset><library_geometries>"
    points = "0 1 0 0 -1 0 "
    vertices = 2
    around = 2 * rings
    for (i = 1; i < rings; i++)
        for (j = 0; j < around; j++) {
            points = points vertex(i, j)
            vertices++
        }
    for (j = 0; j < around; j++) {
        k = (j + 1) % around
        last = 2 + (rings - 2) * around
        corners = corners "0 " 2 + k " " 2 + j " 1 " last + j " " last + k " "
        for (i = 0; i < rings - 2; i++) {
            a = 2 + i * around
            corners = corners a + j " " a + k " " a + around + k " " a + j " " a + around + k " " a + around + j " "
        }
    }
    geometry("sphere", points, vertices, corners, 2 * around * (rings - 1))
    geometry("floor", "-1 0 -1 1 0 -1 1 0 1 -1 0 1", 4, "0 2 1 0 3 2", 2)
    print "</library_geometries><library_visual_scenes><visual_scene id=\"s\">"
    print "<node><scale>" 4 * side " 1 " 4 * side "</scale><instance_geometry url=\"#floor\"/></node>"
    for (i = 0; i < side; i++)
        for (j = 0; j < side; j++) {
            size = 1 + (i + j) % 3 / 4
            print "<node><translate>" 4 * i - 2 * side + 0.3 " " size " " 4 * j - 2 * side "</translate>"
            print "<rotate>0.28 0.96 0 " 37 * i + 11 * j "</rotate><scale>" size " " size " " ((i * j) % 4 ? size : -size)
            print "</scale><instance_geometry url=\"#sphere\"/></node>"
        }
    print "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
}
