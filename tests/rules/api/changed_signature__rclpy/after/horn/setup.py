from setuptools import setup

setup(
    name='horn',
    version='1.2.0',
    packages=['horn'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/horn']),
        ('share/horn', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['horn = horn.node:main']},
)
